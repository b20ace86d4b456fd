"""Fitting a vehicle's numbers to a log: what is found, how sure it is, and what the log cannot tell."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dq_marine.checks import finite_array, finite_number
from dq_marine.errors import InvalidInputError
from dq_marine.identification.identifiability import Held, correlated, covariance
from dq_marine.identification.lanes import SegmentedLog
from dq_marine.identification.log import Log
from dq_marine.identification.model import Model, numbers_of
from dq_marine.identification.parameters import (
    CURRENT,
    DEFAULT_GROUPS,
    LARGEST_THETA,
    Parameter,
    Quantity,
    parameters_of,
)
from dq_marine.identification.problem import OUTPUTS, Problem
from dq_marine.identification.search import MOST_ROUNDS, Found, Search, Watch
from dq_marine.vehicles import Vehicle, vehicle_sheet

Array = NDArray[np.float64]

SEGMENTS = 30
"""Of a log, unless they would be shorter than `SHORTEST` or longer than `LONGEST`."""

MOST_STEPS = 1000
"""Of the integrator from one instant of the log to the next, of which one would do."""

SHORTEST, LONGEST = 5.0, 100.0
ACCURATE_STEP = 0.05
"""Step size over the largest step of the vehicle's sheet."""

CLEAN = 10.0
"""Noise over the smallest there is, from which residuals are taken for those of sensors."""


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
    found = Search(problem, parameters, bound, watch).run()
    if found.evaluation.refused:
        raise InvalidInputError(
            f"{found.evaluation.refused} segments of {log.name} cannot be simulated with the numbers found; give a "
            "smaller step, or fit fewer groups"
        )
    return _result(problem, log, segments, parameters, found)


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


def _result(
    problem: Problem, log: Log, segments: SegmentedLog, parameters: Sequence[Parameter], search: Found
) -> Fit:
    theta, free, held, evaluation = search.theta, search.free, search.held, search.evaluation
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
    if not search.settled:
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
        sought = any(parameter.group == CURRENT for parameter in kept)
        perhaps = "" if sought else ", such as a current, which may be fitted, too"
        notes.append(
            f"The residuals of {colour} are no white noise: something is missing in the model{perhaps}. "
            "Standard errors are enlarged for it."
        )
    return tuple(notes)
