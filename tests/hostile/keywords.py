"""Valid keyword arguments of scenes, environments and resets, drawn from a seeded generator."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from hostile.values import Rng

ID = "dq_marine/StationKeeping-v0"


def vector6(rng: Rng) -> Any:
    return rng.normal(size=6)


def vector3(rng: Rng) -> Any:
    return rng.normal(size=3).tolist()


def goal(rng: Rng) -> Any:
    return [float(rng.normal()), float(rng.normal()), float(rng.uniform(1.0, 9.0))]


def quaternion(rng: Rng) -> Any:
    q = rng.normal(size=4)
    return q / np.linalg.norm(q)


def constant(value: Any) -> Callable[[Rng], Any]:
    return lambda rng: value


def one_of(*values: Any) -> Callable[[Rng], Any]:
    return lambda rng: values[rng.integers(len(values))]


def number(least: float, most: float) -> Callable[[Rng], Any]:
    return lambda rng: float(rng.uniform(least, most))


JONSWAP = {"type": "sea", "spectrum": {"type": "jonswap", "height": 1.0, "period": 7.0}, "seed": 1}

CURRENTS = (
    (0.1, 0.2, 0.0),
    {"depths": [0.0, 10.0], "velocities": [[0.5, 0.0], [0.1, 0.0]]},
    {"mean": [0.1, 0.0, 0.0], "standard_deviation": 0.1, "correlation_time": 60.0},
)

SCENE: dict[str, Callable[[Rng], Any]] = {
    "vehicle": one_of("bluerov2_heavy", "remus100", "otter"),
    "current": one_of(*CURRENTS),
    "scheme": one_of("midpoint", "paper", "galerkin", "runge_kutta"),
    "step": number(1e-3, 0.1),
    "order": one_of(2, 4, 6, 8),
    "kick": one_of("l_stable", "implicit_node"),
    "hydrostatics": one_of("linear", "hull"),
    "radiation": one_of("constant", "memory"),
    "weather": one_of([], [JONSWAP], [{"type": "wind", "speed": 5.0, "direction_from": 1.0}]),
    "forces": constant([]),
    "solids": one_of([], [{"kind": "plane", "position_ned": [0.0, 0.0, 5.0]}]),
    "actuation": one_of("wrench", "thrusters"),
    "gravity": one_of(None, 9.81),
}

ENVIRONMENT: dict[str, Callable[[Rng], Any]] = {
    **{name: draw for name, draw in SCENE.items() if name != "step"},
    "control_period": number(0.05, 0.5),
    "substeps": one_of(1, 4),
    "sensors": one_of(None, "auv"),
    "action_delay": one_of(0, 2),
    "observation_delay": one_of(0, 1),
    "perturb": one_of(None, "late_actions", "payload"),
    "randomise": one_of(None, "default"),
    "privileged": one_of(None, "current", ["vehicle", "truth"]),
    "vehicle_pool": constant(4),
    "vehicle_seed": one_of(0, 1),
    "start_radius": number(0.1, 2.0),
    "workspace_radius": number(5.0, 20.0),
    "reward": constant({"effort": 0.1, "position": 0.5, "position_width": 1.0}),
    "goal_position": goal,
    "actuated_axes": one_of(None, "surge sway heave yaw"),
}

OPTIONS: dict[str, Callable[[Rng], Any]] = {
    "position": vector3,
    "quaternion": quaternion,
    "velocity": vector6,
    "current": vector3,
    "goal_position": goal,
    "goal_quaternion": quaternion,
}
