"""Libraries solve the same motions: SciPy with the compiled equations, MuJoCo what it can represent."""

from dataclasses import replace

import numpy as np
import pytest
from support.order import observed_order

from dq_marine.report.cases import CASES
from dq_marine.report.end_state import errors
from dq_marine.report.libraries import LIBRARIES, make_compiled_derivative
from dq_marine.report.ode import make_derivative
from dq_marine.report.references import reference

DAMPED = replace(CASES["damped_bluerov2"], duration=2.0)
SCIPY = tuple(name for name, library in LIBRARIES.items() if library.setting == "rtol")
MUJOCO = tuple(name for name, library in LIBRARIES.items() if library.setting == "step")


@pytest.mark.parametrize("case", [DAMPED, CASES["ship_restoring"]], ids=lambda case: case.name)
def test_the_compiled_equations_are_the_separately_written_ones(case):
    rng = np.random.default_rng(0)
    compiled, plain = make_compiled_derivative(case), make_derivative(case.physics, case.wrench)
    for time in (0.0, 1.7):
        y = np.concatenate([case.position, case.quaternion, rng.normal(size=6)])
        assert np.allclose(compiled(time, y), plain(time, y), rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize("name", SCIPY)
def test_scipy_converges_with_its_tolerance(name):
    end = reference(DAMPED).end
    runs = [LIBRARIES[name].run(DAMPED, rtol) for rtol in (1e-4, 1e-7, 1e-10)]
    found = [max(errors(run.end, end)) for run in runs]
    assert found[0] < 1e-2
    assert found[1] < 1e-4
    assert found[2] < 1e-7
    assert found[0] > found[1] > found[2]
    assert all(run.seconds > 0.0 for run in runs)
    assert runs[0].evaluations < runs[2].evaluations


def test_scipy_knows_the_current():
    """The position in the drifting frame is brought back: a current makes the same motion elsewhere."""
    current = np.array([0.3, -0.2, 0.1])
    moved = replace(DAMPED, physics=replace(DAMPED.physics, current_ned=current))
    found = errors(LIBRARIES["scipy_dop853"].run(moved, 1e-10).end, reference(moved).end)
    assert max(found) < 1e-7


def test_what_scipy_gives_up_is_nowhere():
    """Damping that drives: the velocity is infinite after a finite time."""
    driven = replace(DAMPED, physics=replace(DAMPED.physics, quadratic=-DAMPED.physics.quadratic))
    run = LIBRARIES["scipy_dop853"].run(driven, 1e-6)
    assert np.isnan(run.end.position).all()
    assert np.isnan(max(errors(run.end, reference(DAMPED).end)))


def test_scipy_refuses_nothing():
    assert not any(LIBRARIES[name].refusal(case) for name in SCIPY for case in CASES.values())


@pytest.mark.parametrize("name", MUJOCO)
def test_mujoco_is_given_free_rigid_bodies_only(name):
    refusals = {case.name: LIBRARIES[name].refusal(case) for case in CASES.values()}
    assert [case for case, reason in refusals.items() if not reason] == ["torque_free_top", "dzhanibekov"]
    assert "added mass" in refusals["kirchhoff_bluerov2"]
    assert "nothing acts on" in refusals["damped_bluerov2"]
    pushed = replace(CASES["torque_free_top"], wrench=np.ones(6))
    assert LIBRARIES[name].refusal(pushed)


def test_mujoco_refuses_what_is_no_rigid_body():
    case = CASES["torque_free_top"]
    thin = replace(case, physics=replace(case.physics, mass_matrix=np.diag([1.0, 1.0, 1.0, 1.0, 1.0, 3.0])))
    assert "moments of inertia" in LIBRARIES["mujoco_rk4"].refusal(thin)


@pytest.mark.parametrize("name", MUJOCO)
def test_mujoco_converges_to_the_closed_form_at_its_order(name):
    pytest.importorskip("mujoco")
    case, library = CASES["torque_free_top"], LIBRARIES[name]
    steps = np.array([0.04, 0.02, 0.01] if library.order == 4 else [0.01, 0.005, 0.0025])
    runs = [library.run(case, step) for step in steps]
    found = np.array([errors(run.end, case.exact(case.duration)) for run in runs])
    assert found[:, 0].max() < 1e-11  # straight on
    assert observed_order(steps, found[:, 1]) == pytest.approx(library.order, abs=0.1)
    assert observed_order(steps, found[:, 2]) == pytest.approx(library.order, abs=0.1)
    assert runs[1].evaluations == 2 * runs[0].evaluations
