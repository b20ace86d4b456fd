"""What is to be said of a run, whatever the manoeuvre."""

from __future__ import annotations

import math

import numpy as np

from dq_marine.manoeuvres.series import Series
from dq_marine.vehicles import Vehicle

LARGEST_TILT = math.radians(60.0)
"""Roll or pitch from which a run is no longer taken for one in the horizontal plane."""


def run_notes(vehicle: Vehicle, series: Series) -> tuple[str, ...]:
    """Return what a reader should know of a run in still water: that it did not stay level, or left its validity."""
    left = () if vehicle.validity is None else vehicle.validity.notes(series.velocity_body[:, :3])
    return (*_tilt_notes(series), *_slow_notes(vehicle, series), *left)


def _slow_notes(vehicle: Vehicle, series: Series) -> tuple[str, ...]:
    """Return what is to be said of a whole ship that was slower than its polynomials know."""
    ship, slowest = vehicle.whole_ship, float(series.velocity_body[:, 0].min())
    if ship is None or slowest >= ship.slowest:
        return ()
    return (f"Below {ship.slowest:.3g} m/s ahead its polynomials are continued: it had {slowest:.3g} m/s.",)


def _tilt_notes(series: Series) -> tuple[str, ...]:
    """Return what is to be said of a run that did not stay nearly level: headings and tracks are of level motion."""
    largest = float(np.abs(series.euler[:, :2]).max())
    if largest < LARGEST_TILT:
        return ()
    note = (
        f"It rolled or pitched by up to {math.degrees(largest):.0f} deg, so that figures of the horizontal plane mean "
        "little: nothing holds it level; try less throttle."
    )
    return (note,)
