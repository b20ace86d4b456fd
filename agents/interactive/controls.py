"""The controls of a flight, for the panel of its page."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from dq_marine.envs.core.marine_env import MarineEnv
from dq_marine.envs.core.places import highest_goal
from dq_marine.envs.core.start import GOAL_POSITION
from dq_marine.physics.current.formulas.uniform import MOVING_WATER
from dq_marine.vehicles.model import MOTIONS
from dq_marine.viewer.controls import (
    Axis,
    Button,
    Choice,
    Control,
    Group,
    Number,
    Place,
    Pull,
    Slider,
    Stick,
    Switch,
)
from dq_marine.viewer.models.vehicle_model import GOAL_GHOST
from dq_marine.viewer.models.vehicle_model import VEHICLE as DRAWN_VEHICLE
from dq_marine.viewer.playback import Playback

if TYPE_CHECKING:
    from dq_marine.agents.interactive.helm import Helm

RESET, QUIT, SEED, AGENT = "reset", "quit", "seed", "agent"
STICK, POWER, HOLD = "stick", "power", "hold"
GOAL = "goal"
PULL = "pull"
CURRENT = ("current_speed", "current_bearing")
"""Names of the controls."""

LARGEST_SEED = 2**31 - 1
FASTEST_CURRENT = 1.5
"""That the slider goes to [m/s]."""

GOAL_REACH = 0.5
"""How far its sliders move a goal along an axis, over the radius of the task's workspace, beyond which episodes end."""

GOAL_REACH_IN_LENGTHS = 10.0
"""The same for tasks without a workspace, in vehicle lengths."""

HOLD_REACH = 2.0
"""Farthest from the vehicle's origin that it can be held, in vehicle lengths; what is drawn is within half of that."""

FARTHEST_HAND = 1e6
"""From the world's origin [m]."""

HANDS = {
    "surge": Axis("astern, ahead", "KeyS", "KeyW", (3, -1)),
    "sway": Axis("port, starboard", "KeyQ", "KeyE", (2, 1)),
    "heave": Axis("up, down", "KeyR", "KeyF", (1, 1)),
    "roll": Axis("roll left, right", "KeyJ", "KeyL"),
    "pitch": Axis("bow down, up", "KeyK", "KeyI"),
    "yaw": Axis("turn left, right", "KeyA", "KeyD", (0, 1)),
}
"""Axes of the stick by motion; a gamepad's left stick is depth and turn, its right one ahead and aside."""


def flight_controls(
    env: MarineEnv,
    agents: tuple[str, ...],
    chosen: str,
    *,
    seed: int,
    playback: Playback,
    helm: Helm,
) -> tuple[Group, ...]:
    """Return the controls of an environment's flight.

    Args:
        env: in an episode.
        agents: names of those who can fly.
        chosen: who does.
        seed: of the episode.
        playback: plays, pauses and steps it.
        helm: what the stick belongs to.
    """
    simulation: tuple[Control, ...] = (
        *playback.controls(),
        Button(RESET, "New episode", key="KeyN"),
        Button(QUIT, "Quit"),
        Number(SEED, "seed of the next episode", 0, LARGEST_SEED, seed),
        Choice(AGENT, "flown by", agents, chosen),
    )
    hands: tuple[Control, ...] = (
        Stick(STICK, "helm", tuple(HANDS[MOTIONS[axis]] for axis in driven(env))),
        Slider(POWER, "power", 0.05, 1.0, helm.power, 0.05),
        *((Switch(HOLD, "hold what is let go", helm.hold, key="KeyH"),) if helm.can_hold else ()),
        Pull(
            PULL,
            "pull the vehicle",
            DRAWN_VEHICLE,
            HOLD_REACH * env.vehicle.dimensions.length,
            FARTHEST_HAND,
            key="KeyG",
        ),
    )
    groups = [Group("Flight", simulation), Group("Helm", hands)]
    if env.scene.composition.water == MOVING_WATER:
        north, east, _ = env.episode.current_ned.tolist()
        bearing = math.degrees(math.atan2(east, north)) % 360.0
        most = max(FASTEST_CURRENT, math.hypot(north, east))
        water = (
            Slider(CURRENT[0], "current", 0.0, most, math.hypot(north, east), 0.01, "m/s"),
            Slider(CURRENT[1], "flows towards", 0.0, 360.0, bearing, 1.0, "deg"),
        )
        groups.append(Group("Water", water))
    return (*groups, *_goal_group(env))


def _goal_group(env: MarineEnv) -> tuple[Group, ...]:
    """Return the controls of a goal that can be moved; none where there is no such goal."""
    goal = env.snapshot().goal_position_ned
    if goal is None or GOAL_POSITION not in env.definition.options:
        return ()
    radius = getattr(env, "workspace_radius", None)
    lengths = GOAL_REACH_IN_LENGTHS * env.vehicle.dimensions.length
    reach = lengths if radius is None else GOAL_REACH * radius
    north, east, down = goal.tolist()
    floats = env.vehicle.hydrostatics is not None
    highest = down if floats else min(down, max(highest_goal(env.vehicle), down - reach))
    lowest = down if floats else down + reach
    place = Place(
        GOAL,
        "goal",
        ("north", "east", "depth"),
        (north - reach, east - reach, highest),
        (north + reach, east + reach, lowest),
        (north, east, down),
        0.01,
        thing=GOAL_GHOST,
    )
    return (Group("Goal", (place,), note="Or drag it in the scene; with Shift up and down."),)


def driven(env: MarineEnv) -> NDArray[np.intp]:
    """Return the axes that the vehicle's wrench has, in Fossen's order."""
    return np.flatnonzero(env.vehicle.wrench_limits)


def stick_positions(env: MarineEnv, positions: tuple[float, ...]) -> NDArray[np.float64]:
    """Return the positions of the stick's axes in Fossen's order, shape (6,)."""
    stick = np.zeros(6)
    stick[driven(env)] = positions
    return stick
