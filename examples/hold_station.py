"""Fly the baseline controller for one episode and print how well it holds its place."""

import gymnasium as gym

import dq_marine  # noqa: F401 - registers the environments
from dq_marine.agents.dp_controller import DPController


def main() -> None:
    """Run one episode with a fixed seed."""
    env = gym.make("dq_marine/StationKeeping-v0", current=0.3)
    controller = DPController.for_env(env)
    observation, info = env.reset(seed=1)
    controller.reset(env)
    print(f"start: {info['position_error']:.2f} m from the goal, current {info['current_ned']} m/s")
    terminated = truncated = False
    total = 0.0
    while not (terminated or truncated):
        observation, reward, terminated, truncated, info = env.step(controller.act(observation))
        total += reward
    print(f"end: {info['position_error']:.4f} m from the goal, return {total:.1f}")
    env.close()


if __name__ == "__main__":
    main()
