"""Fitting a vehicle's numbers to a log: what is found, how sure it is, and what the log cannot tell."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dq_marine.checks import finite_array, finite_number
from dq_marine.errors import InvalidInputError
from dq_marine.identification.identifiability import (
    LARGEST_SHARE,
    Held,
    correlated,
    covariance,
    standard_errors,
    told,
)
from dq_marine.identification.lanes import SegmentedLog
from dq_marine.identification.log import Log
from dq_marine.identification.model import Model, numbers_of
from dq_marine.identification.parameters import (
    DEFAULT_GROUPS,
    LARGEST_THETA,
    Parameter,
    Quantity,
    parameters_of,
)
from dq_marine.identification.problem import OUTPUTS, Evaluation, Problem
from dq_marine.util.extras import extra_needed
from dq_marine.vehicles import Vehicle, vehicle_sheet

Array = NDArray[np.float64]

MOST_ROUNDS = 8
"""Of solving for theta, then for starts and noise."""

MOST_EVALUATIONS = 12
"""In a round."""

SETTLED = 0.1
"""A round that moves no parameter by more than this share of its standard error is the last."""

SEGMENTS = 30
"""Of a log, unless they would be shorter than `SHORTEST` or longer than `LONGEST`."""

MOST_STEPS = 1000
"""Of the integrator from one instant of the log to the next, of which one would do."""

SHORTEST, LONGEST = 5.0, 100.0
ACCURATE_STEP = 0.05
"""Step size over the largest step of the vehicle's sheet."""

CLEAN = 10.0
"""Noise over the smallest there is, from which residuals are taken for those of sensors."""

Watch = Callable[[str], None]


@dataclass(frozen=True)
class Conditions:
    """How to fit.

    Attributes:
        groups: what is free, of `dq_marine.identification.GROUPS`.
        bound: largest relative standard error of a parameter that counts as told; others are held.
        segment: length of a segment [s]; None for a thirtieth of the log, from 5 to 100 s.
        step: largest step of the integrator [s]; None for one that is accurate by the vehicle's sheet.
        current: velocity of the water, NED [m/s]; where the current is free, what the search begins from.
    """

    groups: Sequence[str] = DEFAULT_GROUPS
    bound: float = 0.25
    segment: float | None = None
    step: float | None = None
    current: Sequence[float] = (0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Estimate:
    """One number of the vehicle, or of the water.

    Attributes:
        label: for people.
        unit: of the values.
        nominal: in the vehicle's file; of the current, as it was given.
        value: found.
        standard_error: of the value.
    """

    label: str
    unit: str
    nominal: float
    value: float
    standard_error: float


@dataclass(frozen=True)
class Fit:
    """What came out.

    Attributes:
        nominal: the vehicle before.
        vehicle: the vehicle found, under the same name.
        estimates: of the parameters that the log tells.
        held: labels of those that it does not tell, with the relative standard error that each would have.
        notes: what to know about the result, in sentences.
        log: the file's name.
        duration: of the log [s].
        segments: that it was cut into.
        time: of the rows that were compared [s], shape (n,).
        residuals: measured less simulated, NaN where nothing was measured, shape (n, 12), see `OUTPUTS`.
        noise: root of the mean square of the residuals, shape (12,); NaN where nothing was measured.
    """

    nominal: Vehicle
    vehicle: Vehicle
    estimates: tuple[Estimate, ...]
    held: tuple[tuple[str, float], ...]
    notes: tuple[str, ...]
    log: str
    duration: float
    segments: int
    time: Array
    residuals: Array
    noise: Array


def fit_vehicle(
    vehicle: Vehicle, log: Log, conditions: Conditions | None = None, watch: Watch = lambda text: None
) -> Fit:
    """Return the vehicle whose simulated motion is nearest to a log's, in the sense of least squares.

    Each segment of the log is simulated from a start that is fitted, too, and each output counts by its noise, which
    the residuals show: with white noise this is the estimate of maximum likelihood (see docs/theory.md).

    Args:
        vehicle: with a first estimate of all numbers; what is zero stays zero.
        log: of its motion.
        conditions: how to fit; None for the defaults.
        watch: is told what is being done.

    Raises:
        InvalidInputError: a condition is wrong, the log tells nothing of what is to be fitted, or the vehicle found
            cannot be simulated.
        MissingDependencyError: SciPy is not installed.
    """
    conditions = conditions or Conditions()
    bound = finite_number("bound", conditions.bound, above=0.0, most=10.0)
    parameters = _parameters(vehicle, log, conditions)
    model = Model(vehicle, _current(conditions))
    segments = _segments(model, log, conditions)
    problem = Problem(log, model, parameters, segments)
    free, theta, held = list(range(len(parameters))), np.zeros(len(parameters)), list[Held]()
    watch("compiling, and asking what the log can tell")
    problem.take_starts(theta, problem.evaluate(theta, free))
    evaluation = problem.evaluate(theta, free)
    shares = problem.shares_of_noise(theta, free, evaluation)
    settled = False
    for number in range(1, MOST_ROUNDS + 1):
        free, lost = told(evaluation.jacobian, shares, free, bound)
        held += lost
        known = None if lost else evaluation
        _check_something_left(free, parameters, held)
        theta[[one.place for one in held]] = 0.0
        before = theta.copy()
        theta, evaluation = _solved(problem, theta, free, known, watch, number)
        problem.take_starts(theta, evaluation)
        problem.take_noise(evaluation)
        evaluation = problem.evaluate(theta, free)
        shares = problem.shares_of_noise(theta, free, evaluation)
        errors = standard_errors(evaluation.jacobian)
        all_told = errors.max() <= bound and shares.max() <= LARGEST_SHARE
        settled = bool(all_told and (np.abs(theta - before)[free] <= SETTLED * errors).all())
        if settled:
            break
    if evaluation.refused:
        raise InvalidInputError(
            f"{evaluation.refused} segments of {log.name} cannot be simulated with the numbers found; give a smaller "
            "step, or fit fewer groups"
        )
    return _result(problem, log, segments, parameters, theta, free, held, evaluation, settled)


def _parameters(vehicle: Vehicle, log: Log, conditions: Conditions) -> tuple[Parameter, ...]:
    if "gains" in conditions.groups and log.inputs.actuation == "wrench":
        raise InvalidInputError(
            f"fit = {','.join(conditions.groups)}, but {log.name} has the wrench on the body, which gains play no part "
            "in; leave gains out, or log the commands of the actuators"
        )
    return parameters_of(vehicle, conditions.groups)


def _current(conditions: Conditions) -> tuple[float, float, float]:
    north, east, down = finite_array("current", conditions.current, 3).tolist()
    return (north, east, down)


def _segments(model: Model, log: Log, conditions: Conditions) -> SegmentedLog:
    if conditions.segment is None:
        length = min(max(log.duration / SEGMENTS, SHORTEST), LONGEST, log.duration)
    else:
        least = 10.0 * log.period
        length = finite_number("segment", conditions.segment, least=least, most=log.duration)
    if conditions.step is None:
        speed = float(np.nanmax(np.abs(log.velocity_body[:, :3])))
        step = ACCURATE_STEP * vehicle_sheet(model.vehicle, speed=max(speed, 1e-3)).largest_step
    else:
        step = finite_number("step", conditions.step, least=log.period / MOST_STEPS)
    return SegmentedLog(log, model, length, min(step, log.period))


def _check_something_left(free: Sequence[int], parameters: Sequence[Parameter], held: Sequence[Held]) -> None:
    if not free:
        names = ", ".join(parameters[one.place].label for one in held)
        raise InvalidInputError(
            f"the log tells nothing of {names}; give one in which the vehicle moves in more ways, or fit less"
        )


def _solved(
    problem: Problem, theta: Array, free: Sequence[int], known: Evaluation | None, watch: Watch, number: int
) -> tuple[Array, Evaluation]:
    """Return the theta of least squares for the starts and the noise that the problem has, and the problem there.

    Args:
        problem: to be solved.
        theta: to begin from.
        free: the parameters that are sought.
        known: the problem at that theta, if it is known.
        watch: is told of each simulation.
        number: of the round.
    """
    with extra_needed("identification", "report"):
        from scipy.optimize import least_squares
    begin = np.clip(theta[list(free)], -0.99 * LARGEST_THETA, 0.99 * LARGEST_THETA)
    last = {} if known is None else {begin.tobytes(): known}
    count = 0

    def whole(part: Array) -> Array:
        result = theta.copy()
        result[list(free)] = part
        return result

    def at(part: Array) -> Evaluation:
        nonlocal count
        if part.tobytes() not in last:
            last.clear()
            last[part.tobytes()] = problem.evaluate(whole(part), free)
            count += 1
            squares = float((last[part.tobytes()].residual ** 2).sum())
            rms = np.sqrt(squares / problem.readings.sum())
            watch(f"round {number}, simulation {count}: {rms:.4g} times the noise")
        return last[part.tobytes()]

    def residual(part: Array) -> Array:
        return at(part).residual.ravel()

    def jacobian(part: Array) -> Array:
        return at(part).jacobian

    solution = least_squares(
        residual,
        begin,
        jac=jacobian,
        bounds=(-LARGEST_THETA, LARGEST_THETA),
        max_nfev=MOST_EVALUATIONS,
        xtol=1e-6,
        ftol=1e-3,  # the next round goes on
    )
    return whole(solution.x), at(solution.x)


def _result(
    problem: Problem,
    log: Log,
    segments: SegmentedLog,
    parameters: Sequence[Parameter],
    theta: Array,
    free: Sequence[int],
    held: Sequence[Held],
    evaluation: Evaluation,
    settled: bool,
) -> Fit:
    kept = [parameters[index] for index in free]
    residuals = np.where(problem.missing, np.nan, evaluation.residual * problem.noise)
    noisy = problem.noise > CLEAN * problem.smallest_noise  # else it is round-off that follows itself
    growth, colour = _colour(evaluation.residual, problem.missing | ~noisy)
    spread = growth**2 * covariance(evaluation.jacobian)
    rms = np.sqrt(np.nansum(residuals**2, axis=0) / np.maximum(problem.readings, 1))
    given, found = problem.model_at(0.0 * theta), problem.model_at(theta)
    before, after = numbers_of(given, kept), numbers_of(found, kept)
    slopes = np.array([_slopes(problem, kept, theta, index, after) for index in free]).T
    errors = np.sqrt(np.diag(slopes @ spread @ slopes.T))
    notes = _notes(problem, kept, theta[list(free)], held, spread, colour)
    if not settled:
        notes += (
            f"The numbers still moved after {MOST_ROUNDS} rounds: do not trust them; fit fewer groups.",
        )
    estimates = tuple(
        Estimate(new.label, new.unit, old.value, new.value, float(error))
        for old, new, error in zip(before, after, errors, strict=True)
    )
    return Fit(
        given.vehicle,
        found.vehicle,
        estimates,
        tuple((parameters[one.place].label, one.standard_error) for one in held),
        notes,
        log.name,
        log.duration,
        segments.count,
        log.time[segments.rows],
        residuals,
        np.where(problem.readings > 0, rms, np.nan),
    )


def _slopes(
    problem: Problem, kept: Sequence[Parameter], theta: Array, index: int, values: Sequence[Quantity]
) -> list[float]:
    """Return the derivatives of the numbers by one parameter."""
    step = -1e-6 if theta[index] > 0.0 else 1e-6
    moved = numbers_of(problem.model_at(theta + step * np.eye(len(theta))[index]), kept)
    return [(there.value - here.value) / step for there, here in zip(moved, values, strict=True)]


def _colour(residual: Array, missing: NDArray[np.bool_]) -> tuple[float, str]:
    """Return by how much errors are larger because residuals follow each other, and the output that shows it most.

    Of a first-order process with correlation c from row to row, the mean has an error larger by
    sqrt((1 + c)/(1 - c)) than that of white noise (Bartlett 1946).
    """
    growth, output = 1.0, ""
    for column, blank, (name, _) in zip(residual.T, missing.T, OUTPUTS, strict=True):
        values = column[~blank]
        if values.size < 3 or not values.any():
            continue
        correlation = float(values[1:] @ values[:-1] / (values @ values))
        found = np.sqrt((1.0 + correlation) / max(1.0 - correlation, 1e-3)) if correlation > 0.1 else 1.0
        if found > growth:
            growth, output = float(found), name
    return growth, output


def _notes(
    problem: Problem,
    kept: Sequence[Parameter],
    theta: Array,
    held: Sequence[Held],
    spread: Array,
    colour: str,
) -> tuple[str, ...]:
    notes = []
    if held:
        names = ", ".join(problem.label(one.place) for one in held)
        notes.append(
            f"The log does not tell {names}: held as they were given. The other numbers are right if these are."
        )
    for one, other, correlation in correlated(spread)[:5]:
        notes.append(
            f"{kept[one].label} and {kept[other].label} go together (correlation {correlation:.3f}): the log tells one "
            "by the other."
        )
    edge = [
        parameter.label
        for parameter, value in zip(kept, theta, strict=True)
        if abs(value) > 0.95 * LARGEST_THETA
    ]
    if edge:
        notes.append(
            f"{', '.join(edge)}: at the end of its range, about ten times the file's value or a tenth of it, of a "
            f"current {LARGEST_THETA:g} m/s; do not trust it."
        )
    if colour:
        notes.append(
            f"The residuals of {colour} are no white noise: something is missing in the model, such as a current "
            "(which may be fitted, too). Standard errors are enlarged for it."
        )
    return tuple(notes)
