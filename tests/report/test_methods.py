"""Every method does every case that it does not refuse, and converges to the references at its order."""

from dataclasses import replace

import numpy as np
import pytest

from dq_marine.algebra.spatial import from_fossen
from dq_marine.backend.packing import pack
from dq_marine.integrator.classical_runge_kutta import CLASSICAL
from dq_marine.integrator.dormand_prince import DORMAND_PRINCE
from dq_marine.integrator.explicit import foresee_nothing
from dq_marine.integrator.step import ACCEPTED, make_advance
from dq_marine.report.cases import CASES
from dq_marine.report.end_state import end_of, errors
from dq_marine.report.methods import METHODS
from dq_marine.report.references import reference
from dq_marine.report.showing.stability_view import DOP853_IMAGINARY, DOP853_REAL, RK4_IMAGINARY, RK4_REAL
from dq_marine.simulation.batch import Batch

LANES = 9
"""More than a block of lanes holds."""

COUNTS = {1: (100, 200, 400), 2: (20, 40, 80), 4: (8, 12, 18), 6: (5, 7, 9), 8: (3, 4, 5)}
FINER = {
    ("rk4_euler", "kirchhoff_bluerov2"): 8,
    ("gauss8", "kirchhoff_bluerov2"): 2,
    ("dop853", "kirchhoff_bluerov2"): 4,
    ("dop853", "coupled_rexrov"): 2,
}
LONGER = {("rk8", "ship_restoring"): 2.0}
"""Motions [s] in which errors would be those of rounding within the second that others take."""
"""How much finer where a pitch comes near 90 degrees, where the sweeps still end too early to show the order, and where
an explicit method needs shorter steps to show it."""


def end_in_plain_python(method, case, count):
    """Where a method says that a case ends."""
    body = method.body(case.physics, case.duration / count)
    case.place(body)
    wrench = from_fossen(tuple(case.wrench.tolist()))
    outcome = make_advance(body._composition)(body.parameters, body.state, wrench, 0.0, count)
    assert outcome.status == ACCEPTED
    assert outcome.completed == count
    body._state = pack(outcome.state)
    return end_of(body)


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("name", METHODS)
def test_every_method_does_every_case_that_it_does_not_refuse(name, case):
    stiff = case.startswith("damped_bluerov2_x")
    method, case = METHODS[name], replace(CASES[case], duration=4e-7 if stiff else 4e-4)
    if method.refusal(case.physics):
        assert method.order > 4
        assert not case.conservative
        return
    found = errors(end_in_plain_python(method, case, 4), reference(case).end)
    assert max(found) < (3e-6 if method.order == 1 else 1e-8)


@pytest.mark.parametrize("case", ["kirchhoff_bluerov2", "coupled_rexrov", "ship_restoring"])
@pytest.mark.parametrize("name", METHODS)
def test_methods_converge_to_the_reference_at_their_order(name, case):
    method = METHODS[name]
    counts = np.array(COUNTS[method.order]) * FINER.get((name, case), 1)
    case = replace(CASES[case], duration=LONGER.get((name, case), 1.0))
    end = reference(case).end
    measured = np.array([errors(end_in_plain_python(method, case, count), end) for count in counts])
    # Position, attitude and velocity together, each relative to its first: one alone may be exact by symmetry.
    total = (measured / measured[0]).max(axis=1)
    observed = np.polyfit(np.log(1.0 / counts), np.log(total), 1)[0]
    assert observed > method.order - 0.35, measured


def test_names_titles_and_families():
    assert all(name == method.name for name, method in METHODS.items())
    assert len({method.title for method in METHODS.values()}) == len(METHODS)
    assert {method.family for method in METHODS.values()} == {
        "DQVI",
        "Gauss",
        "Explicit",
        "Runge-Kutta",
        "Euler",
        "Lie group",
    }


def test_gauss_of_order_6_is_left_out_where_order_8_is_the_same_method():
    assert "damping" in METHODS["gauss6"].refusal(CASES["damped_bluerov2"].physics)
    assert METHODS["gauss6"].refusal(CASES["heavy_top"].physics) == ""


@pytest.mark.parametrize("name", ["dqvi6", "dqvi8"])
def test_negative_stages_are_refused_where_something_damps(name):
    assert "damping" in METHODS[name].refusal(CASES["damped_bluerov2"].physics)
    assert METHODS[name].refusal(CASES["ship_restoring"].physics) == ""


def test_a_baseline_runs_compiled_like_the_products_own():
    case = CASES["kirchhoff_bluerov2"]
    body = METHODS["rk4_quaternion"].body(case.physics, 0.01)
    case.place(body)
    body.step(case.wrench, 1000)
    assert body.time == pytest.approx(case.duration)
    assert errors(end_of(body), reference(case).end).attitude < 1e-6


@pytest.mark.sweep
def test_rk4_in_lanes_has_the_bits_of_a_single_body():
    """So that it can be compared with what a batch does."""
    method, case = METHODS["rk4_quaternion"], CASES["munk_spheroid"]
    body = method.body(case.physics, 0.02)
    batch = Batch(body._composition, [body.parameters], body.step_size, LANES)
    case.place(body)
    batch.set_state(np.tile(body.get_state(), (LANES, 1)))
    body.step(case.wrench, 50)
    batch.step(case.wrench, 50)
    assert batch.refusals == {}
    assert np.array_equal(batch.get_state(), np.tile(body.get_state(), (LANES, 1)))


@pytest.mark.parametrize(
    ("method", "real", "imaginary"),
    [(CLASSICAL, RK4_REAL, RK4_IMAGINARY), (DORMAND_PRINCE, DOP853_REAL, DOP853_IMAGINARY)],
    ids=["RK4", "DOP853"],
)
def test_stability_ends_where_the_report_says(method, real, imaginary):
    """Of y' = z y: a step makes y no larger just within the bounds, and larger just beyond."""
    take_step = method.make_step(foresee_nothing, lambda z, node, y: z * y)
    for end in (-real, 1j * imaginary):
        assert abs(take_step(complex(0.9999 * end), 1.0, 1.0).reached) < 1.0
        assert abs(take_step(complex(1.0001 * end), 1.0, 1.0).reached) > 1.0
