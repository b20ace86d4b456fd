"""What a step needs to know of a vehicle's actuators; `physics.actuators` has the actuators that there are."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from dq_marine.algebra.spatial import ZERO, Spatial
from dq_marine.integrator.forces import TimeForce, VelocityForce

NO_WRENCH = ZERO


@dataclass(frozen=True)
class Actuation:
    """The functions of a vehicle's actuators.

    Attributes:
        channels: how many there are.
        uses_velocity: whether the force depends on the velocity.
        force: the force on the body, of time alone or of the velocity.
        rest: values of the channels at rest, nested.
        nest: (flat tuple) -> the same numbers nested.
        commands: (channels, actions) -> commands of actions in [-1, 1], both nested.
        targets: (channels, values, commands) -> targets.
        follow: (channels, values, targets, elapsed) -> values after a time [s].
        add_wrenches: (effects, values, twist relative to the water, wrench) -> wrench + what the actuators do.
    """

    channels: int
    uses_velocity: bool
    force: TimeForce | VelocityForce
    rest: Any
    nest: Callable[[Any], Any]
    commands: Callable[[Any, Any], Any]
    targets: Callable[[Any, Any, Any], Any]
    follow: Callable[[Any, Any, Any, float], Any]
    add_wrenches: Callable[[Any, Any, Spatial, Spatial], Spatial]


def nothing_nested(flat: Any) -> tuple[()]:
    """Return the end of a nest."""
    return ()


def nothing_commanded(channels: Any, actions: Any) -> tuple[()]:
    """Return the commands of no channel."""
    return ()


def no_targets(channels: Any, values: Any, commands: Any) -> tuple[()]:
    """Return the targets of no channel."""
    return ()


def nothing_followed(channels: Any, values: Any, targets: Any, elapsed: float) -> tuple[()]:
    """Return the values of no channel."""
    return ()


def nothing_added(effects: Any, values: Any, twist: Spatial, wrench: Spatial) -> Spatial:
    """Return the wrench as it is."""
    return wrench


def no_force(parameters: Any, time: float) -> Spatial:
    """Return no wrench."""
    return NO_WRENCH


NO_ACTUATION = Actuation(
    channels=0,
    uses_velocity=False,
    force=no_force,
    rest=(),
    nest=nothing_nested,
    commands=nothing_commanded,
    targets=no_targets,
    follow=nothing_followed,
    add_wrenches=nothing_added,
)
"""A body that is pushed by wrenches alone."""
