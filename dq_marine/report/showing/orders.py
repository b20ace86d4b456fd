"""Observed orders against those that the methods are said to have."""

from __future__ import annotations

import math

from dq_marine.report.cases import CASES
from dq_marine.report.names import case_title, in_order, order_of, title_of
from dq_marine.report.presentation import Check, Table, power
from dq_marine.report.showing.curves import Curve
from dq_marine.report.showing.rates import SMALL, largest_small_step, smoothness_limit

SMALLEST, LARGEST = 1e-10, 1e-2
"""Errors between which an order is read off: above round-off, and where the motion is followed at all."""

QUANTITIES = ("attitude", "position")

NOT_ENOUGH = "not enough points between too large a step and round-off"

SCATTER = 1.0
"""By how much an order that a kink limits may fall short: the error depends on where in a step the kink falls."""


def expected_order(curve: Curve) -> tuple[int, float] | None:
    """Return the order that a method should show on a case, and the least that passes; None without fixed steps.

    An order is read off a few points, of which the coarsest bend.
    """
    order = order_of(curve.method)
    if order is None:
        return None
    limit = smoothness_limit(CASES[curve.case]) if curve.case in CASES else None
    if limit is not None and order > limit:
        return limit, limit - SCATTER
    return order, 0.9 * order - 0.1


def order_checks(all_curves: dict[str, dict[str, Curve]]) -> list[Check]:
    """Return a check a method and case, undecided where there are not enough points to read an order off."""
    found = []
    for case, curves in all_curves.items():
        for name, curve in curves.items():
            expected, slopes = expected_order(curve), slopes_of(curve)
            if expected is None:
                continue
            order, least = expected
            measured = ", ".join(f"{quantity} {slope:.2f}" for quantity, slope in slopes.items())
            found.append(
                Check(
                    f"order of {title_of(name)} on {case_title(case)}",
                    measured or NOT_ENOUGH,
                    f"{order} (at least {least:.2f})",
                    min(slopes.values()) >= least if slopes else None,
                )
            )
    return found


def slopes_of(curve: Curve) -> dict[str, float]:
    """Return the observed order of each error that has enough points."""
    longest = largest_small_step(CASES[curve.case]) if curve.case in CASES else math.inf
    found = {}
    for quantity in QUANTITIES:
        order = curve.order(quantity, SMALLEST, LARGEST, longest)
        if order is not None:
            found[quantity] = order.slope
    return found


def order_table(all_curves: dict[str, dict[str, Curve]]) -> Table:
    """Return the observed orders of attitude and position, by case and method."""
    names = in_order({name for curves in all_curves.values() for name in curves if order_of(name)})
    lines = []
    for name in names:
        cells = [cell(curves.get(name)) for curves in all_curves.values()]
        lines.append([title_of(name), str(order_of(name)), *cells])
    return Table(
        "Observed orders of attitude and position",
        ["method", "order", *(case_title(case) for case in all_curves)],
        lines,
        f"By least squares over the finest points with errors from {power(SMALLEST)} to {power(LARGEST)}, well above "
        "what the reference is known to, before round-off stops an error from falling, and with steps below "
        f"{SMALL:g} of the damping's time; empty where there are fewer than three. Quadratic damping limits "
        "orders to 3, as |v| v is not smooth where a velocity changes sign; `gauss8` follows that.",
    )


def cell(curve: Curve | None) -> str:
    """Return the orders of one method on one case."""
    if curve is None:
        return ""
    return " / ".join(f"{slope:.1f}" for slope in slopes_of(curve).values())
