"""Explicit Runge-Kutta methods for whole scenes: no equation is solved, and bodies in lanes wait for none.

Momentum, attitude and position are integrated by the stages of a method of order 4 (`classical_runge_kutta`) or 8
(`verner`; `dormand_prince`, whose stability reaches further, where something depends on the velocity), in `runs` of
steps. In free motion the pose is then made consistent with the momentum, which is
exact to round-off (`runge_kutta_free`). The methods are neither variational nor stable for stiff damping; steps that
they cannot take are Strang's, and counted.
"""

from __future__ import annotations

import functools
from collections.abc import Callable

from dq_marine.integrator.classical_runge_kutta import CLASSICAL
from dq_marine.integrator.dormand_prince import DORMAND_PRINCE
from dq_marine.integrator.explicit import Explicit
from dq_marine.integrator.runge_kutta_forced import make_forced_steps
from dq_marine.integrator.runge_kutta_free import make_free_steps
from dq_marine.integrator.runs import make_free_attempt, make_free_unless_pushed, make_method_in_runs
from dq_marine.integrator.step import Advance, Composition
from dq_marine.integrator.verner import VERNER

SMOOTH = {method.order: method for method in (CLASSICAL, VERNER)}
"""By order: for scenes in which no force depends on the velocity."""

DAMPED = {method.order: method for method in (CLASSICAL, DORMAND_PRINCE)}
"""By order: for those in which one does, as damping does."""


def method_for(composition: Composition, order: int) -> Explicit:
    """Return the method of an order that suits a scene."""
    return (DAMPED if composition.velocity_forces else SMOOTH)[order]


@functools.cache
def make_runge_kutta(order: int) -> Callable[[Composition], Advance]:
    """Return the method of an order: (composition) -> advance."""

    def runge_kutta(composition: Composition) -> Advance:
        method = method_for(composition, order)
        free, forced = make_free_steps(method), make_forced_steps(composition, method)
        if composition.forceless:  # steps with forces do not keep what free motion keeps
            forced = make_free_unless_pushed(make_free_attempt(composition, free), forced)
        return make_method_in_runs(composition, free, forced)

    return runge_kutta
