"""The motion and the force that the files of these tests hold."""

from __future__ import annotations

import numpy as np

T = np.arange(1000) * 1e-3
X = 0.01 * np.sin(40.0 * T)
F = 100.0 * np.cos(40.0 * T)
