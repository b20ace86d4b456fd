"""Where each case's motion really leads: closed form or finest solution, with an estimate of its error, kept on disk.

What is kept is found again by a hash over all that made it: the case's numbers, the sources of the equations, of the
closed forms and of the case's forces, and the versions of NumPy and SciPy.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Sequence
from contextlib import suppress
from importlib.metadata import version
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dq_marine.backend.disk_cache import cache_directory
from dq_marine.backend.fingerprint import all_used_functions, constants_of, text_of
from dq_marine.errors import InvalidInputError
from dq_marine.report import closed_forms, ode
from dq_marine.report.cases import Case
from dq_marine.report.end_state import EndState, Errors, errors
from dq_marine.util.extras import extra_needed
from dq_marine.util.files import with_folder, write_json

Array = NDArray[np.float64]

FINEST = 3e-14
"""Relative tolerance of DOP853; SciPy takes no less than 2.3e-14."""

STIFF_TOLERANCE = 1e-11
"""Of the implicit solvers."""


class Reference(NamedTuple):
    """Where a body is at a time, and how well that is known.

    Attributes:
        time: [s].
        end: where the body is.
        error: of it, no more than this: its difference to a second solution.
        source: what made it, and what it was compared with.
    """

    time: float
    end: EndState
    error: Errors
    source: str


def reference(case: Case) -> Reference:
    """Return where a case ends."""
    return references(case, (case.duration,))[0]


def references(case: Case, times: Sequence[float]) -> list[Reference]:
    """Return where a case is at ascending times [s], all after its start; from disk, if it has been asked before.

    Raises:
        MissingDependencyError: SciPy is not installed.
    """
    path = path_of(case, times)
    kept = read(path, times)
    if kept is not None:
        return kept
    made = make(case, times)
    with suppress(InvalidInputError):  # a cache that cannot be written costs time, nothing else
        write_json(with_folder(path), [as_json(each) for each in made])
    return made


def path_of(case: Case, times: Sequence[float]) -> Path:
    """Return the file of a case's references at some times."""
    return cache_directory() / "references" / f"{case.name}-{key_of(case, times)}.json"


def key_of(case: Case, times: Sequence[float]) -> str:
    """Return a hash over all that makes a case's references."""
    functions: list[Callable[..., Any]] = [force.function for force in case.physics.forces]
    functions += [used for function in functions for used in all_used_functions(function)]
    equations: list[Callable[..., Any]] = [  # one of each file
        ode.make_derivative,
        closed_forms.quaternion_matrix,
        key_of,
    ]
    numbers = {
        "case": case.summary(),
        "stiff": case.stiff,
        "exact": repr(case.exact) if case.exact else "",
        "constants": [constants_of(function) for function in functions],
        "times": list(map(float, times)),
        "versions": [version("numpy"), scipy_version()],
    }
    digest = hashlib.sha256(json.dumps(numbers, sort_keys=True).encode())
    for function in (*equations, *functions):
        digest.update(hashlib.sha256(text_of(function)).digest())
    return digest.hexdigest()[:20]


def scipy_version() -> str:
    """Return SciPy's version."""
    with extra_needed("a reference solution", "report"):
        import scipy

    return str(scipy.__version__)


def read(path: Path, times: Sequence[float]) -> list[Reference] | None:
    """Return what is in a file; None if it is not there, or damaged."""
    try:
        kept = [from_json(each) for each in json.loads(path.read_text())]
    except (OSError, ValueError, KeyError, TypeError):
        return None
    return kept if [each.time for each in kept] == list(map(float, times)) else None


def as_json(made: Reference) -> dict[str, Any]:
    """Return a reference as JSON has it."""
    end = {name: value.tolist() for name, value in made.end._asdict().items()}
    return {"time": made.time, "source": made.source, "error": made.error._asdict(), "end": end}


def from_json(kept: Any) -> Reference:
    """Return what `as_json` was given.

    Raises:
        ValueError, KeyError, TypeError: it is not that.
    """
    end = EndState(**{name: np.array(value, dtype=np.float64) for name, value in kept["end"].items()})
    error = Errors(**{name: float(value) for name, value in kept["error"].items()})
    if [part.shape for part in end] != [(3,), (4,), (6,)] or not np.isfinite(np.concatenate(end)).all():
        raise ValueError("not an end state")
    return Reference(float(kept["time"]), end, error, str(kept["source"]))


def make(case: Case, times: Sequence[float]) -> list[Reference]:
    """Return a case's references, solved anew."""
    ends, source, seconds, check = solutions(case, times)
    return [
        Reference(float(time), end, errors(end, second), f"{source}; compared with {check}")
        for time, end, second in zip(times, ends, seconds, strict=True)
    ]


def solutions(case: Case, times: Sequence[float]) -> tuple[list[EndState], str, list[EndState], str]:
    """Return a case's ends and what made them, then second ones and what made those."""
    if case.stiff:
        implicit, multistep = (solved(case, times, method, STIFF_TOLERANCE) for method in ("Radau", "LSODA"))
        settings = f"rtol {STIFF_TOLERANCE:g}"
        return implicit, f"Radau, {settings}", multistep, f"LSODA, {settings}"
    adaptive = solved(case, times, "DOP853", FINEST)
    settings = f"DOP853, rtol {FINEST:g}"
    if case.exact is not None:
        return [case.exact(time) for time in times], "closed form", adaptive, settings
    return solved(case, times, "DOP853", FINEST, halved=True), f"{settings}, steps halved", adaptive, settings


def solved(
    case: Case, times: Sequence[float], method: str, tolerance: float, halved: bool = False
) -> list[EndState]:
    """Return where a solver of SciPy's says that a case is at some times, each the end of a solution from the last.

    Args:
        case: the motion.
        times: ascending [s].
        method: SciPy's name of it.
        tolerance: relative.
        halved: whether to go over each part again, with steps half as large as were needed.
    """
    derivative = ode.make_derivative(case.physics, case.wrench)
    y = ode.start_of(case.physics, case.position, case.quaternion, case.velocity)
    now, ends = 0.0, []
    for time in times:
        y = advance(derivative, (now, float(time)), y, method, tolerance, halved)
        ends.append(ode.end_state(case.physics, y))
        now = float(time)
    return ends


def advance(
    derivative: ode.Derivative,
    span: tuple[float, float],
    y: Array,
    method: str,
    tolerance: float,
    halved: bool,
) -> Array:
    """Return y at the end of a span of time, from y at its start.

    Raises:
        RuntimeError: the solver gave up.
    """
    with extra_needed("a reference solution", "report"):
        from scipy.integrate import solve_ivp

    settings = {"method": method, "rtol": tolerance, "atol": 0.03 * tolerance}
    with np.errstate(over="ignore"):  # Radau's numerical Jacobian meets coordinates that nothing depends on
        solution = solve_ivp(derivative, span, y, **settings)
        if halved and solution.success:
            longest = 0.5 * (span[1] - span[0]) / (len(solution.t) - 1)
            solution = solve_ivp(derivative, span, y, max_step=longest, **settings)
    if not solution.success:
        raise RuntimeError(f"{method} gave up: {solution.message}")
    return np.asarray(solution.y[:, -1], dtype=np.float64)
