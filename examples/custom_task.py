"""A task of your own in one file outside the package: hover above a moving platform. Vectors and checks come with it.

In its folder, from a shell: python -m dq_marine fly --task custom_task:my/HoverAbovePlatform-v0 --agent random.
"""

from typing import Any, NamedTuple

import gymnasium as gym
import numpy as np
from gymnasium.utils.env_checker import check_env

from dq_marine.envs.kit import (
    SLOW_START_DRAWS,
    VELOCITY,
    EpisodeContext,
    Motion,
    Observed,
    Situation,
    Start,
    add,
    add_scaled,
    bounded_vector,
    define_task,
    effort,
    norm,
    observed_velocity,
    rotate_inverse,
    slow_start,
    subtract,
    symmetric3,
)

PLATFORM, ABOVE = (0.0, 0.0, 11.0), (0.0, 0.0, -1.0)  # where it begins, and where to hover, from it [m, NED]


class Parameters(NamedTuple):
    """Numbers of an episode: time between actions [s]."""

    period: float


class Memory(NamedTuple):
    """What is remembered: where to hover [m], velocity of the platform [m/s], both in NED."""

    goal: Any
    velocity: Any


class Metrics(NamedTuple):
    """What `info` and evaluations show: distance from the place to hover at [m]."""

    distance: float


class Rewards(NamedTuple):
    """Terms of the reward, and their weights."""

    nearness: float = 1.0
    effort: float = 0.05


def parameters(settings: Any, context: EpisodeContext) -> Parameters:
    """Return the numbers of an episode."""
    return Parameters(context.control_period)


def start(own: Parameters, uniforms: tuple[float, ...]) -> Start:
    """Return where the vehicle begins."""
    return slow_start(add(PLATFORM, ABOVE), 2.0, 0.0, uniforms, 0)


def initial_memory(own: Parameters, begun: Start, uniforms: tuple[float, ...]) -> Memory:
    """Draw the platform's velocity."""
    north, east, _ = symmetric3(uniforms, SLOW_START_DRAWS)
    return Memory(add(PLATFORM, ABOVE), (0.3 * north, 0.3 * east, 0.0))


def update_memory(own: Parameters, memory: Memory, motion: Motion, measured: Motion) -> Memory:
    """Move the platform on."""
    return Memory(add_scaled(memory.goal, own.period, memory.velocity), memory.velocity)


def observe(own: Parameters, memory: Memory, seen: Motion) -> Any:
    """Return what `observations` lists."""
    goal = rotate_inverse(seen.attitude, subtract(memory.goal, seen.position_ned))
    up = rotate_inverse(seen.attitude, ABOVE)
    return (bounded_vector(goal, 1e3), bounded_vector(up, 1.0), observed_velocity(seen))


def observations(settings: Any, vehicle: Any) -> tuple[Observed, ...]:
    """Return names, units, sizes and bounds of what is observed."""
    goal = Observed("goal_body", "m", 3, 1e3, "the place to hover at, seen from the vehicle")
    return (goal, Observed("up_body", "", 3, 1.0, "where up is"), *VELOCITY)


def measure(own: Parameters, memory: Memory, motion: Motion) -> Metrics:
    """Return the metrics."""
    return Metrics(norm(subtract(memory.goal, motion.position_ned)))


def reward(own: Parameters, weights: Rewards, now: Situation) -> Rewards:
    """Return the terms of the reward, whose sum it is."""
    return Rewards(weights.nearness / (1.0 + now.metrics.distance), effort(weights.effort, now))


def succeeded(own: Parameters, now: Situation) -> Any:
    """Whether the vehicle is where it should be."""
    return now.metrics.distance < 0.2


ID = "my/HoverAbovePlatform-v0"
DRAWS = SLOW_START_DRAWS + 3
define_task(globals(), id=ID, summary="Hover above a moving platform.", draws=DRAWS)


def main() -> None:
    """Check the environment, and compare four that are stepped together with single ones."""
    check_env(gym.make(ID).unwrapped, skip_render_check=True)
    envs = gym.make_vec(ID, num_envs=4)
    singles = [gym.make(ID) for _ in range(4)]
    envs.reset(seed=0)
    for seed, env in enumerate(singles):
        env.reset(seed=seed)
    for _ in range(20):
        actions = envs.action_space.sample()
        together, earned, *_ = envs.step(actions)
        alone = [env.step(action) for env, action in zip(singles, actions, strict=True)]
    same = np.array_equal(together, [one[0] for one in alone]) and earned.tolist() == [
        one[1] for one in alone
    ]
    print("distances [m]:", [round(float(one[4]["distance"]), 2) for one in alone])
    print("the vector has the bits of the singles:", same)


if __name__ == "__main__":
    main()
