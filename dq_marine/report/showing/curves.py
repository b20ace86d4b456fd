"""Curves of error against cost, put together from rows of errors and rows of times."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from dq_marine.report.names import OWN, in_order
from dq_marine.report.plan import Row, Rows, find
from dq_marine.report.showing.fits import Order, cost_at, observed_order

QUANTITIES = {
    "attitude": "attitude error [rad]",
    "position": "position error [m]",
    "velocity": "velocity error [m/s, rad/s]",
}
TIME, EVALUATIONS = "best_ns", "evaluations"
BASELINE = "rk4_quaternion"
"""What DQVI is held against."""

DONE = "done"

ABOVE_KNOWN = 300.0
"""Of what a reference is known to: errors below this times it are not read off, for round-off grows as that does."""


@dataclass(frozen=True)
class Curve:
    """The points of one method on one case, from coarse to fine.

    Attributes:
        case: name.
        method: name.
        points: rows with errors, `evaluations` a simulated second and, if it was taken, `best_ns`, the time for one.
        failures: rows of step sizes at which the method failed.
    """

    case: str
    method: str
    points: Rows
    failures: Rows

    def costs(self, cost: str) -> list[float]:
        """Return the costs of the points that have one."""
        return [row[cost] for row in self._with(cost)]

    def errors(self, quantity: str, cost: str = EVALUATIONS) -> list[float]:
        """Return the errors of the points that have a cost; those that are not finite as infinite."""
        return [_number(row.get(quantity)) for row in self._with(cost)]

    def cost_at(self, quantity: str, target: float, cost: str = TIME) -> float | None:
        """Return the cost of an error, None if it is not reached.

        It is read off points with shorter steps than all that failed: a motion that ends before it blows up, in a few
        steps of any length, tells nothing of those between.
        """
        bound = min((row["step"] for row in self.failures if "step" in row), default=math.inf)
        points = [row for row in self._with(cost) if row.get("step", 0.0) < bound]
        return cost_at([row[cost] for row in points], [_number(row.get(quantity)) for row in points], target)

    def order(
        self, quantity: str, smallest: float, largest: float, longest_step: float = math.inf
    ) -> Order | None:
        """Return the observed order in a range of errors; None without step sizes or with too few points."""
        points = [row for row in self.points if "step" in row and row["step"] <= longest_step]
        known = max((row.get("known_to", 0.0) for row in points), default=0.0)
        return observed_order(
            [row["step"] for row in points],
            [_number(row.get(quantity)) for row in points],
            max(smallest, ABOVE_KNOWN * known),
            largest,
        )

    def _with(self, cost: str) -> Rows:
        return [row for row in self.points if cost in row]


def curves_of(rows: Rows, case: str) -> dict[str, Curve]:
    """Return the curves of a case by method, in the registry's order."""
    own = find(rows, case=case)
    times = {(row["method"], row["steps"]): row for row in find(own, kind="time")}
    errors = find(own, kind="error")
    curves = {}
    for name in in_order({row["method"] for row in errors}):
        members = [_timed(row, times) for row in find(errors, method=name)]
        points = [row for row in members if row["outcome"] == DONE]
        failures = [row for row in members if row["outcome"] != DONE]
        curves[name] = Curve(case, name, points, failures)
    return curves


def best_own(
    curves: dict[str, Curve], quantity: str, target: float, cost: str = TIME
) -> tuple[str, float] | None:
    """Return which of this package's methods reaches an error at the least cost, and that; None if none does."""
    return cheapest(OWN, curves, quantity, target, cost)


def cheapest(
    methods: Sequence[str], curves: dict[str, Curve], quantity: str, target: float, cost: str = TIME
) -> tuple[str, float] | None:
    """Return which of some methods reaches an error at the least cost, and that; None if none does."""
    found = [
        (value, name)
        for name, curve in curves.items()
        if name in methods and (value := curve.cost_at(quantity, target, cost)) is not None
    ]
    return (min(found)[1], min(found)[0]) if found else None


def _timed(row: Row, times: dict[tuple[str, int], Row]) -> Row:
    taken = times.get((row["method"], row.get("steps", -1)))
    return row | {key: taken[key] for key in ("best_ns", "median_ns")} if taken else row


def _number(value: float | None) -> float:
    return math.inf if value is None else value
