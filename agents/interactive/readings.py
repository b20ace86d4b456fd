"""What a flight's panel shows in numbers."""

from __future__ import annotations

from dq_marine.agents.evaluation.metrics import REWARD_PREFIX, metrics_of
from dq_marine.envs.core.marine_env import MarineEnv
from dq_marine.viewer.live import Reading

VELOCITIES = {
    "u, surge": "m/s",
    "v, sway": "m/s",
    "w, heave": "m/s",
    "p, roll rate": "rad/s",
    "q, pitch rate": "rad/s",
    "r, yaw rate": "rad/s",
}


def readings(env: MarineEnv) -> dict[str, tuple[Reading, ...]]:
    """Return what there is to read of an environment's episode now, by heading."""
    measured = env.measured
    north, east, down = env.position_ned.tolist()
    depth = (
        Reading("height", -down, "m") if env.vehicle.hydrostatics is not None else Reading("depth", down, "m")
    )
    held = env.episode.action[env.action_mapping.places].tolist()
    return {
        "Task": tuple(
            Reading(metric.label, float(metric.shown(measured[metric.name])), metric.shown_unit)
            for metric in metrics_of(env.definition)
        ),
        "Motion": (
            Reading("north", north, "m"),
            Reading("east", east, "m"),
            depth,
            *(
                Reading(label, value, unit)
                for (label, unit), value in zip(VELOCITIES.items(), env.velocity_body.tolist(), strict=True)
            ),
        ),
        "Action": tuple(Reading(name, value) for name, value in zip(env.action_names, held, strict=True)),
        "Reward": tuple(
            Reading(name.removeprefix(REWARD_PREFIX), value)
            for name, value in measured.items()
            if name.startswith(REWARD_PREFIX)
        ),
    }
