"""An explicit Runge-Kutta method of order 8 for whole scenes: no equation is solved, and bodies in lanes wait for none.

Momentum, attitude and position are integrated by Dormand and Prince's stages (`dormand_prince`), in `runs` of steps. In
free motion the pose is then made consistent with the momentum, which is exact to round-off (`runge_kutta_free`).
The method is neither variational nor stable for stiff damping; steps that it cannot take are Strang's, and counted.
"""

from __future__ import annotations

from dq_marine.integrator.runge_kutta_forced import make_forced_steps
from dq_marine.integrator.runge_kutta_free import free_steps
from dq_marine.integrator.runs import make_method_in_runs
from dq_marine.integrator.step import Advance, Composition


def make_runge_kutta(composition: Composition) -> Advance:
    """Return the advance of a scene."""
    return make_method_in_runs(composition, free_steps, make_forced_steps(composition))
