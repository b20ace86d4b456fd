"""What libraries offer for the same motions: SciPy's solvers with variable steps, and MuJoCo for what it can represent.

SciPy is given the right-hand side compiled, of the same functions that the baselines are made of: what is timed is
SciPy's own work, not NumPy on vectors of three. MuJoCo has neither the inertia of added mass nor a coupled M; it is
given free rigid bodies in a vacuum, the only cases that are the same motion.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any, Literal, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from dq_marine.algebra.spatial import from_fossen
from dq_marine.backend.compilation import compile_function
from dq_marine.backend.packing import make_load, pack, store, structure_type
from dq_marine.integrator.inertia import momentum_from_twist, twist_from_momentum
from dq_marine.integrator.step import Composition, StepParameters
from dq_marine.report.baselines.dynamics import Point, make_foresee
from dq_marine.report.baselines.rk4_quaternion import make_rates, make_rk4_quaternion
from dq_marine.report.cases import Case
from dq_marine.report.end_state import EndState
from dq_marine.report.methods import compose_baseline
from dq_marine.report.mujoco_bodies import Integrator, refusal, run
from dq_marine.report.ode import end_state, start_of
from dq_marine.util.extras import extra_needed

Array = NDArray[np.float64]
Setting: TypeAlias = Literal["rtol", "step"]


class LibraryRun(NamedTuple):
    """What came of a run.

    Attributes:
        end: where the body is; NaN if the library gave up.
        seconds: wall time, without what is made once for a case.
        evaluations: of the right-hand side.
    """

    end: EndState
    seconds: float
    evaluations: int


@dataclass(frozen=True)
class Library:
    """A library's integrator.

    Attributes:
        name: in files and on the command line.
        title: in tables and plots.
        order: of convergence with the step; 0 if the steps are variable.
        setting: what is varied: the relative tolerance, or the step size [s].
        distribution: the package that it comes in.
        refusal: (case) -> why it cannot do that, in a few words; '' if it can.
        run: (case, setting) -> what came of it.
    """

    name: str
    title: str
    order: int
    setting: Setting
    distribution: str
    refusal: Callable[[Case], str]
    run: Callable[[Case, float], LibraryRun]


NOWHERE = EndState(np.full(3, np.nan), np.full(4, np.nan), np.full(6, np.nan))
"""Where a body is that a library lost."""


def no_refusal(case: Case) -> str:
    """Return '': every case can be done."""
    return ""


def scipy_run(method: str, case: Case, rtol: float) -> LibraryRun:
    """Return a run of one of SciPy's solvers; the absolute tolerance is `rtol` in SI units.

    Raises:
        MissingDependencyError: SciPy is not installed.
    """
    with extra_needed("a library's solution", "report"):
        from scipy.integrate import solve_ivp

    derivative = make_compiled_derivative(case)
    start = start_of(case.physics, case.position, case.quaternion, case.velocity)
    derivative(0.0, start)  # compiles, outside the clock
    begin = time.perf_counter()
    with np.errstate(all="ignore"):  # what blows up is reported as not finite
        solution = solve_ivp(derivative, (0.0, case.duration), start, method=method, rtol=rtol, atol=rtol)
    seconds = time.perf_counter() - begin
    if not (solution.success and np.isfinite(solution.y[:, -1]).all()):
        return LibraryRun(NOWHERE, seconds, int(solution.nfev))
    y = solution.y[:, -1].copy()
    y[:3] += case.duration * case.physics.current_ned  # the right-hand side is in the drifting frame
    return LibraryRun(end_state(case.physics, y), seconds, int(solution.nfev))


def make_compiled_derivative(case: Case) -> Callable[[float, Array], Array]:
    """Return (t, y) -> y', compiled: y as in `report.ode`, but its position in the frame that drifts with the water."""
    composition, parameters_at = compose_baseline(make_rk4_quaternion, case.physics)
    parameters = parameters_at(1.0)
    numbers, wrench = pack(parameters), case.wrench
    compiled = compiled_rates(composition, structure_type(parameters))

    def derivative(at: float, y: Array) -> Array:
        rates = np.empty(13)
        compiled(numbers, at, y, wrench, rates)
        return rates

    return derivative


def compiled_rates(composition: Composition, layout: Any) -> Callable[..., None]:
    """Return (numbers, t, y, wrench, out), which writes y' to `out`; `numbers` are packed parameters of the layout."""
    rates_at, foresee = make_rates(composition), make_foresee(composition)
    load_parameters = make_load(layout)

    def write_rates(numbers: Any, at: float, y: Any, wrench: Any, out: Any) -> None:
        parameters: StepParameters = load_parameters(numbers)
        force = from_fossen((wrench[0], wrench[1], wrench[2], wrench[3], wrench[4], wrench[5]))
        twist = from_fossen((y[7], y[8], y[9], y[10], y[11], y[12]))
        attitude = (y[3], y[4], y[5], y[6])
        point = Point(attitude, (y[0], y[1], y[2]), momentum_from_twist(parameters.inertia, twist))
        (now,) = foresee(parameters, 0.0, at, force, (0.0,))
        rates = rates_at(parameters, point, 0.0, now)
        acceleration = twist_from_momentum(parameters.inertia, rates.momentum)
        store(out, (rates.position, rates.attitude, acceleration.linear, acceleration.angular))

    compiled: Callable[..., None] = compile_function(write_rates, str(layout))
    return compiled


def scipy_solver(name: str, method: str) -> Library:
    """Return one of SciPy's solvers."""
    title = f"SciPy {method}"
    return Library(name, title, 0, "rtol", "scipy", no_refusal, partial(scipy_run, method))


def mujoco_run(integrator: Integrator, evaluations: int, case: Case, step: float) -> LibraryRun:
    """Return a run of one of MuJoCo's integrators, of some evaluations a step."""
    end, seconds = run(case, integrator, step)
    return LibraryRun(end, seconds, evaluations * max(1, round(case.duration / step)))


def mujoco_integrator(name: str, integrator: Integrator, order: int, evaluations: int) -> Library:
    """Return one of MuJoCo's integrators."""
    runner = partial(mujoco_run, integrator, evaluations)
    return Library(name, f"MuJoCo {integrator}", order, "step", "mujoco", refusal, runner)


LIBRARIES = {
    library.name: library
    for library in (
        scipy_solver("scipy_dop853", "DOP853"),
        scipy_solver("scipy_radau", "Radau"),
        scipy_solver("scipy_lsoda", "LSODA"),
        mujoco_integrator("mujoco_euler", "Euler", 1, 1),
        mujoco_integrator("mujoco_implicitfast", "implicitfast", 1, 1),
        mujoco_integrator("mujoco_rk4", "RK4", 4, 4),
    )
}
"""The libraries' integrators by name."""
