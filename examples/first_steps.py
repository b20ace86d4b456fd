"""First steps: make an environment, fly one episode with the baseline controller, and read what `info` says."""

import gymnasium as gym

import dq_marine  # noqa: F401 - registers the environments
from dq_marine.agents import DPController


def main() -> None:
    """Hold a BlueROV2 Heavy in a current for 30 s."""
    env = gym.make("dq_marine/StationKeeping-v0", current=0.3)
    for part in env.unwrapped.observations:
        print(f"{part.size} x {part.name} [{part.unit or 1}]: {part.meaning}")

    controller = DPController.for_env(env)  # or your own: action = env.action_space.sample()
    observation, info = env.reset(seed=1)  # the same seed starts the same episode, to the last bit
    controller.reset(env)
    print(f"start: {info['position_error']:.2f} m from the goal, current {info['current_ned'].round(2)} m/s")

    terminated = truncated = False
    total = 0.0
    while not (terminated or truncated):
        observation, reward, terminated, truncated, info = env.step(controller.act(observation))
        total += reward
    print(f"end: {info['position_error']:.4f} m from the goal, return {total:.1f}")
    print({name: round(float(value), 3) for name, value in info.items() if name.startswith("reward/")})
    env.close()


if __name__ == "__main__":
    main()
