"""Train with stable-baselines3 on many environments that are stepped together. Needs the extra `agents`."""

import importlib.util

import gymnasium as gym


def main() -> None:
    """Train PPO for some thousand steps, which is enough to see the speed and too little to learn."""
    if importlib.util.find_spec("stable_baselines3") is None:
        print('this needs: pip install "dq-marine[agents]"')
        return
    from stable_baselines3 import PPO
    from stable_baselines3.common.vec_env import VecMonitor

    import dq_marine  # noqa: F401 - registers the environments
    from dq_marine.agents import MarineVecEnv

    envs = gym.make_vec("dq_marine/StationKeeping-v0", num_envs=32, autoreset_mode="SameStep")
    learner = PPO("MlpPolicy", VecMonitor(MarineVecEnv(envs)), n_steps=64, batch_size=512, n_epochs=2, seed=0)
    learner.learn(4096)
    print(f"{learner.num_timesteps} steps; a run that learns: dq-marine train --run runs/ppo")

    env = gym.make("dq_marine/StationKeeping-v0")
    observation, _ = env.reset(seed=0)
    action, _ = learner.predict(observation, deterministic=True)
    print("the policy's first action:", action.round(2))
    envs.close()


if __name__ == "__main__":
    main()
