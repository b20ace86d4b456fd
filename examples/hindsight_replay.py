"""A task whose goals differ from episode to episode, learned with SAC and hindsight replay: swim to a point.

Its observation is a dictionary with the goals, as Gymnasium's `GoalEnv` has it, because some of what it observes
belongs to the parts "achieved_goal" and "desired_goal". With a reward of -1 until the point is reached, few episodes
of a beginner earn anything; hindsight replay learns from each as if its end had been the goal.
"""

from typing import Any, NamedTuple

import gymnasium as gym
from stable_baselines3 import SAC, HerReplayBuffer

from dq_marine.agents.training.vec_env import MarineVecEnv
from dq_marine.envs.kit import (
    SLOW_START_DRAWS,
    VELOCITY,
    EpisodeContext,
    Goal,
    Motion,
    Observed,
    Situation,
    Start,
    Vector3,
    add,
    bounded_vector,
    define_task,
    effort,
    norm,
    observed_velocity,
    rotate_inverse,
    scale,
    select,
    slow_start,
    subtract,
    symmetric3,
)

CENTRE, WIDTH, REACH = (
    (0.0, 0.0, 10.0),
    3.0,
    20.0,
)  # of the starts and goals [m]; bound of what is observed [m]


class Parameters(NamedTuple):
    """Numbers of an episode: how near is there [m]."""

    radius: float = 0.5


class Metrics(NamedTuple):
    """Distance from the goal [m]."""

    distance: float


class Rewards(NamedTuple):
    """Terms of the reward, and their weights."""

    goal: float = 1.0
    effort: float = 0.01


def parameters(settings: Any, context: EpisodeContext) -> Parameters:
    """Return the numbers of an episode."""
    return Parameters()


def start(own: Parameters, uniforms: tuple[float, ...]) -> Start:
    """Return where the vehicle begins."""
    return slow_start(CENTRE, WIDTH, 0.0, uniforms, 0)


def initial_memory(own: Parameters, begun: Start, uniforms: tuple[float, ...]) -> Vector3:
    """Draw the goal, from the centre."""
    return scale(WIDTH, symmetric3(uniforms, SLOW_START_DRAWS))


def observe(own: Parameters, goal: Vector3, seen: Motion) -> Any:
    """Return what `observations` lists."""
    up = rotate_inverse(seen.attitude, (0.0, 0.0, -1.0))
    here = bounded_vector(subtract(seen.position_ned, CENTRE), REACH)
    return (bounded_vector(up, 1.0), observed_velocity(seen), here, goal)


def observations(settings: Any, vehicle: Any) -> tuple[Observed, ...]:
    """Return names, units, sizes, bounds, meanings and parts of what is observed."""
    return (
        Observed("up_body", "", 3, 1.0, "where up is"),
        *VELOCITY,
        Observed("position_ned", "m", 3, REACH, "where the vehicle is, from the centre", "achieved_goal"),
        Observed("goal_ned", "m", 3, WIDTH, "where it is to go, from the centre", "desired_goal"),
    )


def measure(own: Parameters, goal: Vector3, motion: Motion) -> Metrics:
    """Return the metrics."""
    return Metrics(norm(subtract(subtract(motion.position_ned, CENTRE), goal)))


def goal_reward(own: Parameters, weights: Rewards, achieved: Vector3, desired: Vector3) -> float:
    """Return -1, but 0 near the goal."""
    return select(norm(subtract(achieved, desired)) < own.radius, 0.0, -weights.goal)


def reward(own: Parameters, weights: Rewards, now: Situation) -> Rewards:
    """Return the terms of the reward, whose sum it is."""
    here = subtract(now.motion.position_ned, CENTRE)
    return Rewards(goal_reward(own, weights, here, now.memory), effort(weights.effort, now))


def succeeded(own: Parameters, now: Situation) -> Any:
    """Whether the vehicle is near the goal."""
    return now.metrics.distance < own.radius


def goal(own: Parameters, memory: Vector3) -> Goal:
    """Return the goal, to be drawn."""
    return Goal(add(CENTRE, memory))


ID = "my/SwimToPoint-v0"
define_task(globals(), id=ID, summary="Swim to a point.", draws=SLOW_START_DRAWS + 3, max_episode_steps=100)


def main(steps: int = 600) -> None:
    """Learn for a moment; some hundred times as many steps make a good pilot."""
    envs = MarineVecEnv(gym.make_vec(ID, num_envs=4, autoreset_mode="SameStep"))
    model = SAC(
        "MultiInputPolicy",
        envs,
        replay_buffer_class=HerReplayBuffer,
        replay_buffer_kwargs={"n_sampled_goal": 4, "copy_info_dict": True},
        learning_starts=4 * 100,
        train_freq=4,
        seed=0,
    )
    model.learn(steps)
    print(
        "learned from", model.num_timesteps, "steps, and from as if they had been meant to end where they did"
    )
    env = gym.make(ID)
    seen, _ = env.reset(seed=0)
    for _ in range(100):
        action, _ = model.predict(seen, deterministic=True)
        seen, earned, *_, info = env.step(action)
    there = env.unwrapped.compute_reward(seen["achieved_goal"], seen["achieved_goal"], info)
    print(f"distance after an episode: {info['distance']:.2f} m")
    print(f"reward of its last step: {earned:.3f}; had the goal been there: {there:.3f}")


if __name__ == "__main__":
    main()
