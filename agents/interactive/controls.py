"""The controls of a flight, for the panel of its page."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from dq_marine.envs.core.marine_env import MarineEnv
from dq_marine.physics.current.formulas.uniform import MOVING_WATER
from dq_marine.vehicles.model import MOTIONS
from dq_marine.viewer.controls import Axis, Button, Choice, Control, Group, Number, Slider, Stick, Switch
from dq_marine.viewer.playback import Playback

if TYPE_CHECKING:
    from dq_marine.agents.interactive.helm import Helm

RESET, QUIT, SEED, AGENT = "reset", "quit", "seed", "agent"
STICK, POWER, HOLD = "stick", "power", "hold"
CURRENT = ("current_speed", "current_bearing")
"""Names of the controls."""

LARGEST_SEED = 2**31 - 1
FASTEST_CURRENT = 1.5
"""That the slider goes to [m/s]."""

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
    return tuple(groups)


def driven(env: MarineEnv) -> NDArray[np.intp]:
    """Return the axes that the vehicle's wrench has, in Fossen's order."""
    return np.flatnonzero(env.vehicle.wrench_limits)


def stick_positions(env: MarineEnv, positions: tuple[float, ...] | None) -> NDArray[np.float64]:
    """Return the positions of the stick's axes in Fossen's order, shape (6,); None lets go of all."""
    stick = np.zeros(6)
    if positions is not None:
        stick[driven(env)] = positions
    return stick
