"""All actuators of a vehicle as one force that depends on time, and how a command reaches it.

An actuator's state does not depend on the body (see `kernel.actuator_channels`). Over one call of the step it is
therefore a function of time and of a few numbers, the `Drive`: the state at the start, what the command leads to, and
when. `make_actuated_advance` writes them into the force's parameters, advances, and reads the state at the end. The
integrator knows nothing of it and keeps its order.

Channels stand in the order of the actuators; their numbers are nested in pairs, (first, (second, (..., ()))).
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

from dq_marine.kernel.actuator_channels import ChannelKind, scaled_command
from dq_marine.kernel.actuator_effects import EffectKind
from dq_marine.kernel.dual_quaternion import DualQuaternion
from dq_marine.kernel.forces import PoseForce, VelocityForce
from dq_marine.kernel.spatial import Spatial, spatial_add

NO_WRENCH = Spatial((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
AT_REST_IN_WATER = Spatial((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))


class ActuatorKind(NamedTuple):
    """The functions of one actuator: what it does, and how its channels follow."""

    effect: EffectKind
    channels: tuple[ChannelKind, ...]


class Drive(NamedTuple):
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
        drive: what they are doing.
    """

    channels: Any
    effects: Any
    step: float
    drive: Drive


@dataclass(frozen=True)
class Actuation:
    """The functions of a vehicle's actuators.

    Attributes:
        channels: how many there are.
        uses_velocity: whether the force depends on the velocity.
        force: the pose force, or velocity force, on the body.
        rest: values of the channels at rest, nested.
        nest: (flat tuple) -> the same numbers nested.
        commands: (channels, actions) -> commands of actions in [-1, 1], both nested.
        aim: (channels, values, commands) -> targets.
        follow: (channels, values, targets, elapsed) -> values after a time [s].
        add_wrenches: (effects, values, twist relative to the water, wrench) -> wrench + what the actuators do.
    """

    channels: int
    uses_velocity: bool
    force: PoseForce | VelocityForce
    rest: Any
    nest: Callable[[Any], Any]
    commands: Callable[[Any, Any], Any]
    aim: Callable[[Any, Any, Any], Any]
    follow: Callable[[Any, Any, Any, float], Any]
    add_wrenches: Callable[[Any, Any, Spatial, Spatial], Spatial]


@functools.cache
def make_actuation(kinds: tuple[ActuatorKind, ...]) -> Actuation:
    """Return the functions of actuators of the given kinds; equal kinds have the same functions."""
    channels = tuple(channel for kind in kinds for channel in kind.channels)
    effects = tuple(kind.effect for kind in kinds)
    follow, add_wrenches = join_followers(channels), join_effects(effects)

    def posed_actuators(actuators: Actuators, pose: DualQuaternion, time: float) -> Spatial:
        drive = actuators.drive
        values = follow(actuators.channels, drive.values, drive.targets, time - drive.since)
        return add_wrenches(actuators.effects, values, AT_REST_IN_WATER, NO_WRENCH)

    def moving_actuators(actuators: Actuators, pose: DualQuaternion, twist: Spatial, time: float) -> Spatial:
        drive = actuators.drive
        values = follow(actuators.channels, drive.values, drive.targets, time - drive.since)
        return add_wrenches(actuators.effects, values, twist, NO_WRENCH)

    moving = any(effect.uses_velocity for effect in effects)
    return Actuation(
        channels=len(channels),
        uses_velocity=moving,
        force=moving_actuators if moving else posed_actuators,
        rest=nested([0.0] * len(channels)),
        nest=make_nest(0, len(channels)),
        commands=make_commands(len(channels)),
        aim=join_aims(channels),
        follow=follow,
        add_wrenches=add_wrenches,
    )


def nested(numbers: Sequence[Any]) -> Any:
    """Return (first, (second, (..., ())))."""
    pairs: Any = ()
    for number in reversed(numbers):
        pairs = (number, pairs)
    return pairs


def nothing_nested(flat: Any) -> tuple[()]:
    """Return the end of a nest."""
    return ()


def nothing_commanded(channels: Any, actions: Any) -> tuple[()]:
    """Return the commands of no channel."""
    return ()


def nothing_aimed(channels: Any, values: Any, commands: Any) -> tuple[()]:
    """Return the targets of no channel."""
    return ()


def nothing_followed(channels: Any, values: Any, targets: Any, elapsed: float) -> tuple[()]:
    """Return the values of no channel."""
    return ()


def nothing_added(effects: Any, values: Any, twist: Spatial, wrench: Spatial) -> Spatial:
    """Return the wrench as it is."""
    return wrench


def make_nest(first: int, count: int) -> Callable[[Any], Any]:
    """Return (flat tuple) -> its numbers from `first` to `count`, nested."""
    if first == count:
        return nothing_nested
    rest = make_nest(first + 1, count)

    def nest(flat: Any) -> Any:
        return (flat[first], rest(flat))

    return nest


def make_commands(count: int) -> Callable[[Any, Any], Any]:
    """Return (channels, actions) -> commands."""
    if count == 0:
        return nothing_commanded
    rest = make_commands(count - 1)

    def commands(channels: Any, actions: Any) -> Any:
        return (scaled_command(channels[0], actions[0]), rest(channels[1], actions[1]))

    return commands


def join_aims(kinds: tuple[ChannelKind, ...]) -> Callable[[Any, Any, Any], Any]:
    """Return (channels, values, commands) -> targets."""
    if not kinds:
        return nothing_aimed
    first, rest = kinds[0].aim, join_aims(kinds[1:])

    def aim(channels: Any, values: Any, commands: Any) -> Any:
        return (first(channels[0], values[0], commands[0]), rest(channels[1], values[1], commands[1]))

    return aim


def join_followers(kinds: tuple[ChannelKind, ...]) -> Callable[[Any, Any, Any, float], Any]:
    """Return (channels, values, targets, elapsed) -> values."""
    if not kinds:
        return nothing_followed
    first, rest = kinds[0].follow, join_followers(kinds[1:])

    def follow(channels: Any, values: Any, targets: Any, elapsed: float) -> Any:
        value = first(channels[0].dynamics, values[0], targets[0], elapsed)
        return (value, rest(channels[1], values[1], targets[1], elapsed))

    return follow


def join_effects(kinds: tuple[EffectKind, ...]) -> Callable[[Any, Any, Spatial, Spatial], Spatial]:
    """Return (effects, values, twist, wrench) -> wrench + the sum of all effects."""
    if not kinds:
        return nothing_added
    first, rest = kinds[0].wrench, join_effects(kinds[1:])

    def add_with_one(effects: Any, values: Any, twist: Spatial, wrench: Spatial) -> Spatial:
        added = spatial_add(wrench, first(effects[0], values, twist))
        return rest(effects[1], values[1], twist, added)

    def add_with_two(effects: Any, values: Any, twist: Spatial, wrench: Spatial) -> Spatial:
        added = spatial_add(wrench, first(effects[0], values, twist))
        return rest(effects[1], values[1][1], twist, added)

    return add_with_one if kinds[0].channels == 1 else add_with_two


NO_ACTUATION = make_actuation(())
"""A body that is pushed by wrenches alone."""
