"""Checks pass where theory holds, fail where the numbers are doctored, and do not look at the clock."""

from __future__ import annotations

import copy

import pytest
from report import synthetic

from dq_marine.report.plan import Rows
from dq_marine.report.registry import STUDIES
from dq_marine.report.showing.page import checks_of


def failures(name: str, rows: Rows) -> list[str]:
    """Names of the checks that fail."""
    return [check.name for check in STUDIES[name].checks(rows) if check.passed is False]


@pytest.mark.parametrize("name", STUDIES)
def test_theory_passes(name: str) -> None:
    assert failures(name, synthetic.results()[name]) == []


def test_every_claim_of_theory_is_checked() -> None:
    names = [check.name for check in checks_of(STUDIES, synthetic.results())]
    assert len(names) == len(set(names))
    for start in (
        "order of DQVI, order 4 on",
        "order of RK4, quaternion on",
        "momentum of DQVI, order 2",
        "energy of DQVI, order 2",
        "damping bound of RK4, quaternion",
        "restoring bound of DQVI, order 2",
        "DQVI, order 2 never takes a wrong branch",
        "ordinary steps",
    ):
        assert any(name.startswith(start) for name in names), start


@pytest.mark.parametrize(("method", "order"), [("dqvi4", 3.0), ("dqvi2", 1.0), ("rk4_quaternion", 2.0)])
def test_an_order_that_is_too_low_fails(method: str, order: float) -> None:
    rows = synthetic.work_precision(orders={method: order})
    assert synthetic.slope_between(rows, method) == pytest.approx(order)
    assert len(failures("work_precision", rows)) == 1
    assert failures("work_precision", rows)[0].startswith("order of")


def test_an_error_that_does_not_vanish_fails() -> None:
    """Only near round-off may an error stop falling."""
    rows = synthetic.work_precision()
    for row in rows:
        if row["method"] == "dqvi4" and row["kind"] == "error":
            row["attitude"] += 1e-5
    assert failures("work_precision", rows) == ["order of DQVI, order 4 on Spheroid turning broadside"]


def test_an_order_without_enough_points_is_said_and_neither_passes_nor_fails() -> None:
    rows = synthetic.work_precision()
    few = [row for row in rows if row["method"] != "dqvi4" or row["steps"] in synthetic.LEVELS[:2]]
    (check,) = [one for one in STUDIES["work_precision"].checks(few) if "DQVI, order 4" in one.name]
    assert check.passed is None
    assert check.verdict == "undecided"
    assert check.measured.startswith("not enough points")
    assert failures("work_precision", few) == []


def test_quadratic_damping_limits_what_is_asked_of_high_orders_only() -> None:
    """|v| v has a kink: order 3 passes for RK4, order 1.5 fails for it, and DQVI of order 2 must have its own."""
    case = "damped_bluerov2"
    kinked = synthetic.error_rows(case=case, orders={"rk4_quaternion": 3.0, "dqvi4": 2.6})
    fine = [row | {"step": row["step"] / 100.0} for row in kinked]
    assert not any("RK4" in name or "order 4" in name for name in failures("work_precision", fine))
    low = synthetic.error_rows(case=case, orders={"rk4_quaternion": 1.5, "dqvi2": 1.5})
    assert len(failures("work_precision", [row | {"step": row["step"] / 100.0} for row in low])) == 2


@pytest.mark.parametrize("kind", ["damping", "restoring"])
@pytest.mark.parametrize("method", ["rk4_quaternion", "semi_implicit_euler", "dqvi2"])
@pytest.mark.parametrize("factor", [0.9, 1.1])
def test_a_bound_that_is_off_fails(kind: str, method: str, factor: float) -> None:
    rows = synthetic.stability()
    for row in rows:
        if row["kind"] == kind and row["method"] == method and row["failing_step"] is not None:
            row["largest_step"] *= factor
            row["failing_step"] *= factor
    finite = not (kind == "damping" and method == "dqvi2")
    assert len(failures("stability_map", rows)) == int(finite)


def test_an_l_stable_method_that_fails_is_found() -> None:
    rows = synthetic.stability()
    row = next(row for row in rows if row["kind"] == "damping" and row["method"] == "dqvi4")
    row |= {"failing_step": 3.0, "largest_step": 2.9, "failure": "blew up"}
    assert failures("stability_map", rows) == ["damping bound of DQVI, order 4"]


def test_a_method_that_should_never_be_stable_is_found() -> None:
    rows = synthetic.stability()
    row = next(row for row in rows if row["kind"] == "restoring" and row["method"] == "explicit_euler")
    row |= {"largest_step": 0.5, "failing_step": 0.6}
    assert failures("stability_map", rows) == ["restoring bound of Explicit Euler"]


def test_energy_that_drifts_is_found() -> None:
    found = failures("long_run", synthetic.long_run(drift=1e-7))
    assert found
    assert all(name.startswith("energy of DQVI") for name in found)


def test_momentum_that_is_lost_is_found() -> None:
    rows = synthetic.long_run()
    next(row for row in rows if row["steps"] == 10000 and row["method"] == "dqvi4")[
        "linear_momentum_error"
    ] = 1e-8
    assert len(failures("long_run", rows)) == 1
    assert failures("long_run", rows)[0].startswith("momentum of DQVI, order 4")


def test_a_run_that_ended_early_is_found() -> None:
    rows = synthetic.long_run()
    next(row for row in rows if row["steps"] == 10000 and row["method"] == "dqvi2")["outcome"] = (
        "wrong_branch"
    )
    assert len(failures("long_run", rows)) == 2


def test_a_wrong_branch_is_found() -> None:
    rows = synthetic.extreme()
    rows[0] |= {"branch_whole": 3, "branch_other": 1}
    assert failures("extreme", rows) == ["DQVI, order 2 never takes a wrong branch in silence"]


def test_branches_that_were_never_looked_at_do_not_pass() -> None:
    rows = synthetic.extreme()
    for row in rows:
        if row["method"] == "dqvi2":
            row |= {"branch_steps": 0, "branch_whole": 0, "branch_split": 0}
    assert failures("extreme", rows) == ["DQVI, order 2 never takes a wrong branch in silence"]


def test_dqvi_that_blows_up_is_found() -> None:
    rows = synthetic.extreme()
    rows[1]["outcome"] = "blew up"
    assert failures("extreme", rows) == ["DQVI, order 2 never blows up in extremes"]


def test_ordinary_steps_that_need_the_fallback_are_found() -> None:
    rows = synthetic.solver()
    rows[1]["how"] = "fallbacks"
    assert failures("solver", rows) == ["ordinary steps need neither fallback nor refusal"]


def test_wall_time_decides_nothing() -> None:
    results = synthetic.results()
    slow = copy.deepcopy(results)
    for rows in slow.values():
        for row in rows:
            for name in ("best_ns", "median_ns"):
                if name in row:
                    row[name] *= 1e6
    assert checks_of(STUDIES, slow) == checks_of(STUDIES, results)
