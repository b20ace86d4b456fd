"""Observed order of convergence."""

from __future__ import annotations

import numpy as np


def observed_order(steps, errors):
    """Slope of log error over log step, by least squares."""
    return float(np.polyfit(np.log(steps), np.log(errors), 1)[0])
