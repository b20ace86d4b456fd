"""All actuators of a vehicle as one force that depends on time, and how a command reaches it.

An actuator's state does not depend on the body (see `physics.actuators.formulas.channels`). Over one call of the step
it is therefore a function of time and of a few numbers, the `Transient`: the state at the start, what the command leads
to, and when. `make_actuated_advance` writes them into the force's parameters, advances, and reads the state at the
end. The integrator knows nothing of it and keeps its order.

Channels stand in the order of the actuators; their numbers are nested in pairs, (first, (second, (..., ()))).
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any, NamedTuple, TypeAlias

from dq_marine.algebra.dual_quaternion import DualQuaternion
from dq_marine.algebra.nesting import folded, nested
from dq_marine.algebra.spatial import ZERO, Spatial, spatial_add
from dq_marine.integrator.actuation import (
    Actuation,
    no_targets,
    nothing_added,
    nothing_commanded,
    nothing_followed,
    nothing_nested,
)
from dq_marine.physics.actuators.formulas.channels import ChannelKind, scaled_command
from dq_marine.physics.actuators.formulas.effects import EffectKind

Targets: TypeAlias = Callable[[Any, Any, Any], Any]
Follow: TypeAlias = Callable[[Any, Any, Any, float], Any]
AddWrenches: TypeAlias = Callable[[Any, Any, Spatial, Spatial], Spatial]


class ActuatorKind(NamedTuple):
    """The functions of one actuator: what it does, and how its channels follow."""

    effect: EffectKind
    channels: tuple[ChannelKind, ...]


class Transient(NamedTuple):
    """What the channels do from a time on.

    Attributes:
        values: of the channels at that time.
        targets: values that the commands lead to.
        since: that time [s].
    """

    values: Any
    targets: Any
    since: float


class Actuators(NamedTuple):
    """Parameters of the actuators' force.

    Attributes:
        channels: a `Channel` for each channel.
        effects: parameters of each actuator's effect.
        step: step size [s].
        transient: what they are doing now.
    """

    channels: Any
    effects: Any
    step: float
    transient: Transient


@functools.cache
def make_actuation(kinds: tuple[ActuatorKind, ...]) -> Actuation:
    """Return the functions of actuators of the given kinds; equal kinds have the same functions."""
    channels = tuple(channel for kind in kinds for channel in kind.channels)
    effects = tuple(kind.effect for kind in kinds)
    follow, add_wrenches = join_followers(channels), join_effects(effects)

    def resting_actuators(actuators: Actuators, time: float) -> Spatial:
        transient = actuators.transient
        values = follow(actuators.channels, transient.values, transient.targets, time - transient.since)
        return add_wrenches(actuators.effects, values, ZERO, ZERO)

    def moving_actuators(actuators: Actuators, pose: DualQuaternion, twist: Spatial, time: float) -> Spatial:
        transient = actuators.transient
        values = follow(actuators.channels, transient.values, transient.targets, time - transient.since)
        return add_wrenches(actuators.effects, values, twist, ZERO)

    moving = any(effect.uses_velocity for effect in effects)
    return Actuation(
        channels=len(channels),
        uses_velocity=moving,
        force=moving_actuators if moving else resting_actuators,
        rest=nested([0.0] * len(channels)),
        nest=make_nest(len(channels)),
        commands=make_commands(len(channels)),
        targets=join_targets(channels),
        follow=follow,
        add_wrenches=add_wrenches,
    )


def make_nest(count: int) -> Callable[[Any], Any]:
    """Return (flat tuple of so many numbers) -> the same nested."""

    def link(index: int, rest: Callable[[Any], Any]) -> Callable[[Any], Any]:
        def nest(flat: Any) -> Any:
            return (flat[index], rest(flat))

        return nest

    return folded(link, range(count), nothing_nested)


def make_commands(count: int) -> Callable[[Any, Any], Any]:
    """Return (channels, actions) -> commands."""

    def link(_: int, rest: Callable[[Any, Any], Any]) -> Callable[[Any, Any], Any]:
        def commands(channels: Any, actions: Any) -> Any:
            return (scaled_command(channels[0], actions[0]), rest(channels[1], actions[1]))

        return commands

    return folded(link, range(count), nothing_commanded)


def join_targets(kinds: tuple[ChannelKind, ...]) -> Targets:
    """Return (channels, values, commands) -> targets."""

    def link(kind: ChannelKind, rest: Targets) -> Targets:
        first = kind.target

        def targets(channels: Any, values: Any, commands: Any) -> Any:
            return (first(channels[0], values[0], commands[0]), rest(channels[1], values[1], commands[1]))

        return targets

    return folded(link, kinds, no_targets)


def join_followers(kinds: tuple[ChannelKind, ...]) -> Follow:
    """Return (channels, values, targets, elapsed) -> values."""

    def link(kind: ChannelKind, rest: Follow) -> Follow:
        first = kind.follow

        def follow(channels: Any, values: Any, targets: Any, elapsed: float) -> Any:
            value = first(channels[0].dynamics, values[0], targets[0], elapsed)
            return (value, rest(channels[1], values[1], targets[1], elapsed))

        return follow

    return folded(link, kinds, nothing_followed)


def join_effects(kinds: tuple[EffectKind, ...]) -> AddWrenches:
    """Return (effects, values, twist, wrench) -> wrench + the sum of all effects."""

    def link(kind: EffectKind, rest: AddWrenches) -> AddWrenches:
        first = kind.wrench

        def add_with_one(effects: Any, values: Any, twist: Spatial, wrench: Spatial) -> Spatial:
            added = spatial_add(wrench, first(effects[0], values, twist))
            return rest(effects[1], values[1], twist, added)

        def add_with_two(effects: Any, values: Any, twist: Spatial, wrench: Spatial) -> Spatial:
            added = spatial_add(wrench, first(effects[0], values, twist))
            return rest(effects[1], values[1][1], twist, added)

        return add_with_one if kind.channels == 1 else add_with_two

    return folded(link, kinds, nothing_added)
