"""The misfit in a residual: how much, where, and what is known of its kind."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from erdctl.core.recording import Array
from erdctl.diagnose.residual.spectral_line import SpectralLine
from erdctl.diagnose.residual.travel_line import TravelLine


@dataclass(frozen=True, eq=False)
class LackOfFit:
    """The misfit in a residual.

    predicted : (n,) the part whose value is predicted, by regressions that have not seen it [N]
    excess : (n,) mean square beyond noise, predicted or only expected in size [N^2]
    noise_rms, misfit_rms : of what is noise, and of the rest [N]
    significant : whether there is a rest;  hint : whether a further search is worth while
    spectral_line : that turns over with the motion, if the rest holds one
    impulses : the share of the rest's square that they hold, if there are any
    hum : a line of the force channel's own, which is noise
    travel_line : what comes again with every so much travel, if the rest holds it
    records : standard deviation of the gains of records, if these differ unlike those of a rig
    loud : (n,) the mean square of what a record holds that is unlike the others [N^2]
    measures : the statistics on which this rests, by the names of their thresholds
    """

    predicted: Array
    excess: Array
    noise_rms: float
    misfit_rms: float
    significant: bool
    hint: bool
    spectral_line: SpectralLine | None
    impulses: float
    hum: SpectralLine | None = None
    travel_line: TravelLine | None = None
    records: float = 0.0
    loud: Array | None = None
    measures: Mapping[str, float] = field(default_factory=dict)

    def square(self, found: Array) -> Array:
        """(n,) expected square of the misfit [N^2] of which a model has found a part (n,) [N].

        What is predicted has a sign, and adds to what was found; variance beyond noise has none.
        """
        return (found + self.predicted) ** 2 + np.maximum(self.excess - self.predicted**2, 0.0)
