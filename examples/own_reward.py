"""A reward of your own: other weights for the task's terms, and a term that you add."""

import gymnasium as gym

from dq_marine import RewardTerm
from dq_marine.algebra.vector3 import dot
from dq_marine.task.protocol import Situation


def turning(now: Situation) -> float:
    """Return minus the square of the angular velocity [rad^2/s^2]; compiled with the task's own terms."""
    rate = now.motion.velocity.angular
    return -dot(rate, rate)


def main() -> None:
    """Step once and show that the reward is the sum of its terms."""
    env = gym.make(
        "dq_marine/StationKeeping-v0",
        reward={"effort": 0.2},  # a wrong name lists those that there are
        extra_rewards=[RewardTerm("calm", turning, weight=0.5)],
    )
    print("weights:", env.unwrapped.reward_weights._asdict())
    env.reset(seed=0)
    _, reward, _, _, info = env.step(env.action_space.sample())
    terms = {name: float(value) for name, value in info.items() if name.startswith("reward/")}
    print(f"reward {reward:.4f} is the sum of", {name: round(value, 4) for name, value in terms.items()})
    if abs(sum(terms.values()) - reward) > 1e-12:
        raise SystemExit("the terms do not add up")
    # The same keywords go to gym.make_vec, and TensorBoard shows each term of a training run.


if __name__ == "__main__":
    main()
