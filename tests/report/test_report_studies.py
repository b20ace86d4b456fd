"""The studies measure what they say: invariants, bounds, branches, outcomes, iterations."""

from __future__ import annotations

import numpy as np
import pytest
from support.sweeps import sweep
from support.timings import without_timings

from dq_marine.integrator.drift import MAX_PIECES
from dq_marine.report import branch, extreme, long_run, solver, stability_map, work_precision
from dq_marine.report.cases import CASES
from dq_marine.report.cells import FACTORS, cells, random_inertia
from dq_marine.report.invariants import energy, momentum_errors
from dq_marine.report.methods import METHODS
from dq_marine.report.physics import Physics
from dq_marine.report.plan import Plan, find
from dq_marine.report.registry import STUDIES
from dq_marine.report.timing import Timing
from dq_marine.report.trial import BLEW_UP, DONE, evaluations_of, trial

SPHEROID = Physics(np.diag([35.39387824, 60.86052274, 60.86052274, 0.20453077, 2.79541877, 2.79541877]))
MUNK_RATE = 2.301752703506763  # growth rate at 1 m/s


def test_units_have_names_of_their_own_and_settings_that_json_can_hold() -> None:
    for plan in (Plan(), Plan(quick=True)):
        for study in STUDIES.values():
            units = study.units(plan)
            assert len({unit.name for unit in units}) == len(units)
            assert all("/" not in unit.name for unit in units)
            assert all(unit.weight > 0.0 for unit in units)


def test_a_case_can_be_asked_for_alone() -> None:
    units = work_precision.STUDY.units(Plan(quick=True, cases=("munk_spheroid",)))
    assert units
    assert all(unit.name.startswith("munk_spheroid-") for unit in units)


def test_a_trial_says_how_it_failed_and_stays_where_it_was() -> None:
    body = trial(METHODS["dqvi2"], SPHEROID, 1.0)
    body.reset(velocity_body=(2.0 * MAX_PIECES / MUNK_RATE * 1.01, 0.0, 0.0, 0.0, 0.0, 0.0))
    before = body.get_state()
    assert body.attempt() == "wrong_branch"
    assert np.array_equal(body.get_state(), before)
    euler = trial(METHODS["explicit_euler"], SPHEROID, 1.0)
    euler.reset(velocity_body=(1e3, 1.0, 0.0, 1.0, 1e3, 1.0))
    assert euler.attempt(steps=500) == BLEW_UP


def test_evaluations_are_those_of_the_physics() -> None:
    method = METHODS["dqvi4"]
    assert evaluations_of(method, SPHEROID) == method.evaluations
    damped = Physics(SPHEROID.mass_matrix, linear=np.eye(6))
    assert evaluations_of(method, damped) == method.damped_evaluations


# branch


def stepped(velocity: tuple[float, ...], h: float = 1.0):
    """States before and after a step of DQVI of order 2, and the body."""
    body = trial(METHODS["dqvi2"], SPHEROID, h)
    body.reset(velocity_body=velocity)
    before = body.get_state()[1:]
    assert body.attempt() == DONE
    return before, body.get_state()[1:], body


def test_an_ordinary_step_is_confirmed_whole() -> None:
    before, after, body = stepped((0.5, 0.1, 0.0, 0.2, 0.1, 0.3), 0.1)
    assert branch.confirmed_pieces("dqvi2", body.parameters.inertia, 0.1, before, after) == 1


def test_a_split_step_is_confirmed_in_pieces() -> None:
    """Straight ahead beyond the translation limit the way from rest loses its branch, that of half a step does not."""
    before, after, body = stepped((2.1 / MUNK_RATE, 0.0, 0.0, 0.0, 0.0, 0.0))
    assert body.fallback_steps == 1
    assert branch.confirmed_pieces("dqvi2", body.parameters.inertia, 1.0, before, after) == 2


def test_a_split_step_off_that_axis_is_confirmed_in_pieces() -> None:
    """There, a whole step's way from rest exists, too, but it leads elsewhere than the pieces do."""
    before, after, body = stepped((2.1 / MUNK_RATE, 0.02, 0.01, 0.0, 0.01, 0.0))
    assert body.fallback_steps == 1
    assert branch.confirmed_pieces("dqvi2", body.parameters.inertia, 1.0, before, after) > 1


def test_another_solution_is_not_confirmed() -> None:
    """The same step, claimed to end a little elsewhere."""
    before, after, body = stepped((0.5, 0.1, 0.0, 0.2, 0.1, 0.3), 0.1)
    after[1] += 1e-4
    assert branch.confirmed_pieces("dqvi2", body.parameters.inertia, 0.1, before, after) == 0


# extreme


def test_cells_follow_from_the_seed() -> None:
    one, same, other = (cells(Plan(quick=True, seed=seed))[5] for seed in (0, 0, 1))
    assert np.array_equal(one.velocity, same.velocity)
    assert np.array_equal(one.physics.mass_matrix, same.physics.mass_matrix)
    assert not np.array_equal(one.velocity, other.velocity)


def test_cells_cover_every_combination_and_have_what_they_say() -> None:
    grid = cells(Plan())
    assert len(grid) == np.prod([len(values) for values in FACTORS.values()])
    for cell in grid[:: len(grid) // 20]:
        assert np.linalg.norm(cell.velocity[3:]) == pytest.approx(cell.levels["spin"])
        assert np.linalg.norm(cell.velocity[:3]) == pytest.approx(cell.levels["speed"])
        assert np.linalg.norm(cell.position) == pytest.approx(cell.levels["distance"])
        assert np.linalg.norm(cell.quaternion) == pytest.approx(1.0)


@pytest.mark.parametrize("condition", [1.0, 1e3, 1e6])
def test_inertia_has_the_condition_asked_for(condition: float) -> None:
    m = random_inertia(np.random.default_rng(0), condition)
    assert np.array_equal(m, m.T)
    assert np.linalg.cond(m) == pytest.approx(condition, rel=1e-6)


@pytest.mark.parametrize(
    ("outcome", "ratio", "error", "name"),
    [
        (DONE, 1.0, 0.001, "accurate"),
        (DONE, 1.0, np.inf, "bounded"),
        (DONE, 0.6, 0.5, "bounded"),
        (DONE, 0.4, 0.5, "wrong in silence"),
        (DONE, 30.0, np.inf, "wrong in silence"),
        (DONE, np.nan, np.inf, "blew up"),
        (BLEW_UP, 1.0, np.inf, "blew up"),
        ("wrong_branch", 1.0, np.inf, "refused"),
    ],
)
def test_outcomes(outcome: str, ratio: float, error: float, name: str) -> None:
    assert extreme.named_outcome(outcome, ratio, error) == name


def test_a_mild_motion_is_accurate_and_a_wild_one_is_refused_or_lost() -> None:
    grid = cells(Plan())
    mild = next(
        cell
        for cell in grid
        if cell.levels["spin"] == 1.0 and cell.levels["condition"] == 1.0 and cell.step == 1e-3
    )
    exact = extreme.exact_motion(mild, (4, 16))
    assert exact is not None
    for name in ("dqvi2", "rk4_quaternion"):
        row = extreme.row_of(mild, METHODS[name], exact)
        assert row["outcome"] == "accurate"
        assert row.get("branch_other", 0) == 0
    wild = next(
        cell for cell in grid if cell.levels == mild.levels | {"spin": 1000.0, "condition": 1e6, "step": 0.2}
    )
    assert extreme.exact_motion(wild, (4,)) is None
    assert extreme.row_of(wild, METHODS["dqvi2"], None)["outcome"] == "refused"
    assert extreme.row_of(wild, METHODS["rk4_quaternion"], None)["outcome"] == "blew up"


# long runs


def test_energy_and_momentum_of_a_righted_body_are_kept_by_small_steps() -> None:
    case = long_run.long_cases()[long_run.RIGHTED]
    body = trial(METHODS["dqvi4"], case.physics, 0.002)
    case.place(body)
    start, momentum = energy(case.physics, body), body.spatial_momentum
    body.step(steps=2000)
    assert energy(case.physics, body) == pytest.approx(start, rel=1e-9)
    assert body.kinetic_energy != pytest.approx(start, rel=1e-3)
    assert max(momentum_errors(case.physics, momentum, body.spatial_momentum)) < 1e-12


def test_what_is_not_constant_does_not_count() -> None:
    start, now = np.array([1.0, 0.0, 0.0, 2.0, 0.0, 0.0]), np.array([1.0, 0.0, 0.3, 2.0, 0.5, 0.0])
    free, righted = Physics(np.eye(6)), Physics(np.eye(6), arm=np.array([0.0, 0.0, 1.0]))
    heavy = Physics(np.eye(6), excess_weight=1.0)
    assert momentum_errors(free, start, now) == pytest.approx((0.3, 0.25))
    assert momentum_errors(righted, start, now) == pytest.approx((0.3, 0.0))
    assert momentum_errors(heavy, start, now) == (0.0, 0.0)


def test_samples_lie_evenly_on_a_logarithmic_axis() -> None:
    counts = long_run.sampled_steps(1000)
    assert (counts[0], counts[-1]) == (1, 1000)
    assert (np.diff(counts) > 0).all()


def test_a_run_that_blows_up_ends_with_its_failure() -> None:
    rows = long_run.run(CASES[long_run.FREE], METHODS["explicit_euler"], 0.1, 2000)
    assert [row["outcome"] for row in rows[:-1]] == [DONE] * (len(rows) - 1)
    assert rows[-1]["outcome"] == BLEW_UP
    assert "energy_error" not in rows[-1]


# stability


def test_a_bound_is_found() -> None:
    def probe(step: float) -> str:
        return DONE if step <= 0.37 else "wrong_branch"

    stable, failing, how = stability_map.largest_stable(probe, 1e-3, 20)
    assert stable is not None
    assert failing is not None
    assert stable <= 0.37 < failing
    assert failing / stable < 1.0001
    assert how == "wrong_branch"


def test_no_bound_and_no_stable_step_are_told_apart() -> None:
    assert stability_map.largest_stable(lambda step: DONE, 1e-3, 5) == (
        stability_map.LARGEST_STEP,
        None,
        "",
    )
    assert stability_map.largest_stable(lambda step: BLEW_UP, 1e-3, 5) == (None, 1e-3, BLEW_UP)


@pytest.mark.parametrize(
    ("kind", "method", "bound"),
    sweep(
        [
            ("damping", "rk4_quaternion", 2.785),
            ("restoring", "dqvi2", 2.0),
            ("restoring", "rk4_quaternion", 2.828),
        ],
        plain=[("restoring", "dqvi2", 2.0)],
    ),
)
def test_bounds_of_theory_are_found(kind: str, method: str, bound: float) -> None:
    row = stability_map.rows_of(kind, METHODS[method], (10.0,), 10)[0]
    assert 10.0 * row["largest_step"] == pytest.approx(bound, rel=0.01)


def test_damping_of_any_stiffness_leaves_dqvi_stable() -> None:
    row = stability_map.rows_of("damping", METHODS["dqvi2"], (1e5,), 5)[0]
    assert row["failing_step"] is None


# solver


def test_ordinary_steps_are_counted_one_by_one() -> None:
    rows = solver.ordinary_rows(1, 0)
    assert sum(row["steps"] for row in rows) % 4 == 0
    assert {row["how"] for row in rows} == {"direct"}


# work against precision


def test_errors_fall_and_are_the_same_again() -> None:
    case, method = CASES["munk_spheroid"], METHODS["rk4_quaternion"]
    first, second = (work_precision.error_rows(case, method, (80, 160, 320)) for _ in range(2))
    assert first == second
    errors = [row["attitude"] for row in first]
    assert errors[0] > errors[1] > errors[2] > 0.0


def test_a_method_stops_where_it_cannot_be_better() -> None:
    rows = work_precision.error_rows(CASES["munk_spheroid"], METHODS["dqvi8"], work_precision.FULL_LEVELS)
    assert len(rows) < len(work_precision.FULL_LEVELS)


def test_times_are_taken_of_every_step_size_that_works() -> None:
    case, methods = CASES["munk_spheroid"], [METHODS["dqvi2"], METHODS["rk4_quaternion"]]
    rows = work_precision.time_rows(case, methods, (80, 5120), 2)
    assert {(row["method"], row["steps"]) for row in rows} == {
        (method.name, steps) for method in methods for steps in (80, 5120)
    }
    fine, coarse = (find(rows, method="dqvi2", steps=steps)[0]["best_ns"] for steps in (5120, 80))
    assert fine > 10.0 * coarse
    assert all("best_ns" not in row for row in without_timings(rows))


@pytest.mark.parametrize(
    ("many", "one", "best"),
    [
        ((9.0, 5.0, 7.0), (1.0, 2.0, 3.0), 1.0),  # four steps more than one
        ((5.0, 5.1, 5.2), (1.0, 8.0, 9.0), 1.0),  # the machine was busy with something else
        ((3.0, 3.0, 3.0), (4.0, 3.5, 3.0), 0.6),  # the call itself cannot be told from the steps
    ],
)
def test_the_time_of_a_step_is_never_less_than_nothing(many, one, best):
    each = work_precision.seconds_each(Timing(many, 1.0), Timing(one, 1.0), 5)
    assert each.best == pytest.approx(best)
    assert each.median >= each.best > 0.0
    assert work_precision.seconds_each(Timing(many, 1.0), None, 5).best == pytest.approx(min(many) / 5)
