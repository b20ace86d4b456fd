"""From matrices in Fossen's order to the pure functions and tuples of a step, leaving out what is zero."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Literal, NamedTuple

import numpy as np

from dq_marine.algebra.dual_quaternion import DualQuaternion, pose_from_parts
from dq_marine.algebra.nesting import nested
from dq_marine.algebra.spatial import ZERO, Spatial
from dq_marine.checks import shown
from dq_marine.errors import InvalidInputError
from dq_marine.integrator.water import Water
from dq_marine.physics.branching import branching_pose_force, branching_time_force, branching_velocity_force


class ForceTerm(NamedTuple):
    """A force that a scene has.

    Attributes:
        name: what it is called.
        function: a plain function, compiled with the step, `(parameters, pose, time) -> Spatial`, with
            `uses_velocity` `(parameters, pose, twist, time) -> Spatial`, and with `uses_pose=False`
            `(parameters, time) -> Spatial`; see `dq_marine.integrator.forces`. It is found by its names: functions that
            it calls are imported by name, not through their module.
        parameters: nested tuples of floats, handed to the function.
        uses_velocity: whether it depends on the velocity.
        branches: whether the function asks `if`, `and`, `or`, `not`, `min` or `max` of a number that is a body's own. A
            batch then calls it for one body at a time, which is slower than lanes; `dq_marine.algebra.selection` has
            what lanes can do instead.
        potential: of a force that has one, `(parameters, pose) -> energy` [J], whose negative gradient the force is.
            Gauss's collocation then keeps the energy exactly.
        uses_pose: whether it depends on the pose. What depends on time alone, as a thrust that was planned does, is
            evaluated at all stages of an explicit step at once, which takes less time.
    """

    name: str
    function: Callable[..., Spatial]
    parameters: Any
    uses_velocity: bool = False
    branches: bool = False
    potential: Callable[..., float] | None = None
    uses_pose: bool = True

    @property
    def kind(self) -> Literal["time", "pose", "velocity"]:
        """As what the step takes it: see `integrator.forces`."""
        if self.uses_velocity:
            return "velocity"
        return "pose" if self.uses_pose or self.branches else "time"

    @property
    def compiled_form(self) -> Callable[..., Spatial]:
        """The function as the step has it."""
        if not self.branches:
            return self.function
        if self.uses_velocity:
            return branching_velocity_force(self.function)
        return (branching_pose_force if self.uses_pose else branching_time_force)(self.function)

    def wrench_at(self, pose: DualQuaternion, twist: Spatial, time: float) -> Spatial:
        """Return what the force is somewhere."""
        if self.uses_velocity:
            return self.function(self.parameters, pose, twist, time)
        return self.function(self.parameters, *((pose, time) if self.uses_pose else (time,)))


def nested_parameters(terms: tuple[ForceTerm, ...]) -> Any:
    """Return the terms' parameters as the step wants them: (first, (second, (..., ())))."""
    return nested([term.parameters for term in terms])


class WaterTerm(NamedTuple):
    """The effect of moving water.

    Attributes:
        name: of the term; empty if the water is still.
        water: the pure functions.
        parameters: their numbers, nested tuples.
    """

    name: str
    water: Water
    parameters: Any


def checked_forces(forces: Sequence[ForceTerm]) -> tuple[ForceTerm, ...]:
    """Return the forces, each checked by `checked_force`.

    Raises:
        InvalidInputError: one is wrong, or they are no sequence.
    """
    if isinstance(forces, ForceTerm) or not isinstance(forces, Sequence):
        raise InvalidInputError(f"forces = {shown(forces)}; give a list of dq_marine.physics.term.ForceTerm")
    return tuple(checked_force(force) for force in forces)


def checked_force(force: ForceTerm) -> ForceTerm:
    """Return the force if it gives a finite wrench for a body at rest.

    Raises:
        InvalidInputError: it is no `ForceTerm`, or its function does not take or return what it should.
    """
    if not isinstance(force, ForceTerm):
        raise InvalidInputError(
            f"forces has {shown(force)}; give dq_marine.physics.term.ForceTerm(name, function, parameters)"
        )
    if force.uses_velocity and not force.uses_pose:
        raise InvalidInputError(
            f"force {force.name!r} has uses_velocity=True and uses_pose=False; a function of the velocity takes the "
            "pose, too: leave uses_pose out"
        )
    pose = pose_from_parts((1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    try:
        wrench = force.wrench_at(pose, ZERO, 0.0)
        finite = bool(np.isfinite([*wrench.angular, *wrench.linear]).all())
    except Exception as error:
        takes = ["parameters", "pose"][: 1 + force.uses_pose] + ["twist"] * force.uses_velocity + ["time"]
        raise InvalidInputError(
            f"force {force.name!r} cannot be evaluated at rest: {type(error).__name__}: {error}; its function takes "
            f"({', '.join(takes)}) and returns Spatial(moment, force)"
        ) from error
    if not finite:
        raise InvalidInputError(f"force {force.name!r} gives {wrench} at rest; it must be finite")
    return force
