"""Fault emulation, Sec. 6: `inverse` (Eqs. 24-35), `iterate` (corrected models), `plan` (both)."""

from erdctl.mimic.hold import follow
from erdctl.mimic.inverse import YieldLaw, static_duty
from erdctl.mimic.outcome import Correction, Plan, Reach
from erdctl.mimic.plan import mimic

__all__ = ["Correction", "Plan", "Reach", "YieldLaw", "follow", "mimic", "static_duty"]
