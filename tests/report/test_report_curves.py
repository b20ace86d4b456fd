"""Errors and times come together, and the best is the best."""

from __future__ import annotations

import math

import pytest
from matplotlib import rc_context
from report import synthetic

from dq_marine.report.names import OWN
from dq_marine.report.showing.curves import best_own, curves_of
from dq_marine.report.showing.work_precision_view import draw_case
from dq_marine.util.plot_style import SETTINGS


def test_errors_and_times_of_a_step_size_come_together() -> None:
    curves = curves_of(synthetic.work_precision(), synthetic.CASE)
    curve = curves["rk4_quaternion"]
    assert len(curve.points) == len(synthetic.LEVELS)
    assert [row["best_ns"] for row in curve.points] == [80.0 * steps for steps in synthetic.LEVELS]


def test_failures_are_kept_apart() -> None:
    curve = curves_of(synthetic.work_precision(), synthetic.CASE)["dqvi_paper"]
    assert [row["steps"] for row in curve.failures] == [20]
    assert len(curve.points) == len(synthetic.LEVELS) - 1


def test_points_without_a_time_have_no_cost_in_time() -> None:
    curve = curves_of(synthetic.error_rows(), synthetic.CASE)["dqvi2"]
    assert curve.costs("best_ns") == []
    assert curve.cost_at("attitude", 1e-3) is None
    assert curve.cost_at("attitude", 1e-3, "evaluations") is not None


def test_a_library_has_its_time_with_its_error_and_no_order() -> None:
    rows = [
        {
            "kind": "error",
            "case": "munk_spheroid",
            "method": "scipy_dop853",
            "setting": setting,
            "evaluations": 100.0 - math.log10(setting),
            "outcome": "done",
            "attitude": setting,
            "best_ns": 1e4 / setting,
        }
        for setting in (1e-3, 1e-5, 1e-7, 1e-9)
    ]
    curve = curves_of(rows, "munk_spheroid")["scipy_dop853"]
    assert curve.cost_at("attitude", 1e-4) == pytest.approx(1e8)
    assert curve.order("attitude", 1e-12, 1.0) is None


def test_nothing_is_read_across_steps_that_failed() -> None:
    """In five steps an explicit method is at an end before it blows up."""
    outcomes = {5: ("done", 0.9), 10: ("blew up", None), 20: ("done", 1e-5), 40: ("done", 1e-6)}
    rows = [
        {
            "kind": "error",
            "case": "munk_spheroid",
            "method": "explicit_euler",
            "steps": steps,
            "step": 1.0 / steps,
            "evaluations": float(steps),
            "outcome": outcome,
            "attitude": error,
        }
        for steps, (outcome, error) in outcomes.items()
    ]
    curve = curves_of(rows, "munk_spheroid")["explicit_euler"]
    assert curve.cost_at("attitude", 1e-2, "evaluations") == 20.0
    assert len(curve.points) == 3


def test_the_best_own_method_is_the_cheapest_that_gets_there() -> None:
    curves = curves_of(synthetic.work_precision(), synthetic.CASE)
    for target in (1e-2, 1e-6):
        best = best_own(curves, "attitude", target)
        assert best is not None
        costs = {name: curve.cost_at("attitude", target) for name, curve in curves.items() if name in OWN}
        assert best[1] == min(cost for cost in costs.values() if cost is not None) == costs[best[0]]
    assert best_own({}, "attitude", 1e-2) is None


def test_failures_are_drawn_where_points_of_the_same_cost_would_be() -> None:
    """A library that fails has a time, too, and that in the axis' unit."""
    rows = synthetic.work_precision()
    lost = {"kind": "error", "case": synthetic.CASE, "method": "mujoco_euler", "outcome": "blew up"}
    rows.append(lost | {"evaluations": 100.0, "best_ns": 2000.0, "median_ns": 2000.0})
    with rc_context(SETTINGS):
        figure = draw_case(curves_of(rows, synthetic.CASE))
    left, right = figure.axes[0].get_xlim()
    assert right < 1e-1
    assert left < 2e-6 < right
