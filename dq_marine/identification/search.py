"""The search for theta: rounds of least squares, after each of which starts and noise are those of the new theta."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dq_marine.errors import InvalidInputError
from dq_marine.identification.identifiability import LARGEST_SHARE, Held, standard_errors, told
from dq_marine.identification.parameters import LARGEST_THETA, Parameter
from dq_marine.identification.problem import Evaluation, Problem
from dq_marine.util.extras import extra_needed

Array = NDArray[np.float64]
Watch = Callable[[str], None]

MOST_ROUNDS = 30
"""Of solving for theta, then for starts and noise."""

MOST_EVALUATIONS = 4
"""In a round: few, because the starts that belong to another theta are known to first order only."""

SETTLED = 0.1
"""A round that moves no parameter by more than this share of its standard error is the last."""

STEADY = 0.1
"""A round that changes the noise of an output by more than this share is still on its way to the log: what the log
seems not to tell is not held yet, for a bad fit makes all noise large."""


class Found(NamedTuple):
    """Where the search ended.

    Attributes:
        theta: of all parameters; 0 for those that are held.
        free: the parameters that the log tells.
        held: the others.
        evaluation: the problem there.
        settled: whether the last round moved nothing.
    """

    theta: Array
    free: list[int]
    held: list[Held]
    evaluation: Evaluation
    settled: bool


class Search:
    """A search in a problem."""

    def __init__(self, problem: Problem, parameters: Sequence[Parameter], bound: float, watch: Watch) -> None:
        """Begin from the vehicle as its file has it.

        Args:
            problem: to be solved.
            parameters: of it.
            bound: largest standard error of theta that counts as told.
            watch: is told what is being done.
        """
        self._problem, self._parameters, self._bound, self._watch = problem, parameters, bound, watch
        self._theta = np.zeros(len(parameters))
        self._everything = list(range(len(parameters)))
        self._free, self._held = self._everything, list[Held]()

    def run(self) -> Found:
        """Return where it ends.

        Raises:
            InvalidInputError: the log tells nothing of what is sought.
            MissingDependencyError: SciPy is not installed.
        """
        self._watch("compiling, and asking what the log can tell")
        problem = self._problem
        problem.take_starts(self._theta, problem.evaluate(self._theta, self._free))
        evaluation, shares = self._examined(self._free)
        steady, settled, asked_again = True, False, False
        for number in range(1, MOST_ROUNDS + 1):
            lost = (
                self._hold(*told(evaluation.jacobian, shares, self._free, self._bound)) if steady else False
            )
            before, noise = self._theta.copy(), problem.noise
            self._theta, solved = self._solved(None if lost else evaluation, number)
            problem.take_starts(self._theta, solved)
            problem.take_noise(solved)
            evaluation, shares = self._examined(self._free)
            steady = bool((np.abs(problem.noise / noise - 1.0) <= STEADY).all())
            settled = steady and self._is_settled(evaluation, shares, before)
            if settled and (asked_again or not self._held or number == MOST_ROUNDS):
                break
            if settled:
                asked_again = True
                evaluation, shares = self._released()
        return Found(self._theta, self._free, self._held, evaluation, settled)

    def _examined(self, free: Sequence[int]) -> tuple[Evaluation, Array]:
        """Return the problem, and how much of what it feels of each parameter comes from noise."""
        evaluation = self._problem.evaluate(self._theta, free)
        return evaluation, self._problem.shares_of_noise(self._theta, free, evaluation)

    def _is_settled(self, evaluation: Evaluation, shares: Array, before: Array) -> bool:
        errors = standard_errors(evaluation.jacobian)
        all_told = errors.max() <= self._bound and shares.max() <= LARGEST_SHARE
        return bool(all_told and (np.abs(self._theta - before)[self._free] <= SETTLED * errors).all())

    def _hold(self, free: list[int], lost: list[Held]) -> bool:
        """Hold what the log does not tell, and return whether there was any."""
        self._free, self._held = free, [*self._held, *lost]
        if not free:
            names = ", ".join(self._parameters[one.place].label for one in self._held)
            raise InvalidInputError(
                f"the log tells nothing of {names}; give one in which the vehicle moves in more ways, or fit less"
            )
        self._theta[[one.place for one in self._held]] = 0.0
        return bool(lost)

    def _released(self) -> tuple[Evaluation, Array]:
        """Let all be free again: the noise is small now, and may tell what it hid far from the log."""
        self._free, self._held = self._everything, []
        return self._examined(self._free)

    def _solved(self, known: Evaluation | None, number: int) -> tuple[Array, Evaluation]:
        """Return the theta of least squares for the starts and the noise that the problem has, and the problem there.

        Args:
            known: the problem at the present theta, if it is known.
            number: of the round.
        """
        with extra_needed("identification", "report"):
            from scipy.optimize import least_squares
        problem, free = self._problem, list(self._free)
        begin = np.clip(self._theta[free], -0.99 * LARGEST_THETA, 0.99 * LARGEST_THETA)
        last = {} if known is None else {begin.tobytes(): known}
        count = 0

        def whole(part: Array) -> Array:
            result = self._theta.copy()
            result[free] = part
            return result

        def at(part: Array) -> Evaluation:
            nonlocal count
            if part.tobytes() not in last:
                last.clear()
                last[part.tobytes()] = problem.evaluate(whole(part), free)
                count += 1
                squares = float((last[part.tobytes()].residual ** 2).sum())
                rms = np.sqrt(squares / problem.readings.sum())
                self._watch(f"round {number}, simulation {count}: {rms:.4g} times the noise")
            return last[part.tobytes()]

        solution = least_squares(
            lambda part: at(part).residual.ravel(),
            begin,
            jac=lambda part: at(part).jacobian,
            bounds=(-LARGEST_THETA, LARGEST_THETA),
            max_nfev=MOST_EVALUATIONS,
            xtol=1e-6,
            ftol=1e-3,  # the next round goes on
        )
        return whole(solution.x), at(solution.x)
