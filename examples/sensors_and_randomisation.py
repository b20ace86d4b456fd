"""What the agent is told need not be true, and no two episodes need fly the same vehicle: sensors and randomisation."""

import gymnasium as gym

from dq_marine import AHRS, DVL, DepthMeter


def main() -> None:
    """Start some episodes, each with another vehicle and other biases."""
    env = gym.make(
        "dq_marine/StationKeeping-v0",
        sensors=[
            DVL(
                noise=0.01, rate=5.0, dropout=0.1
            ),  # standard deviation [m/s], readings in a second, share lost
            DepthMeter(noise=0.01, bias=0.03),  # m
            AHRS(noise=0.005, bias=0.02),  # rad
        ],
        randomise="default",  # or the path of a TOML file with ranges of your own
        vehicle_pool=20,
        vehicle_seed=0,
    )
    print("observed:", ", ".join(part.name for part in env.unwrapped.observations))
    for seed in range(5):
        _, info = env.reset(seed=seed)
        drawn = env.unwrapped.flown_vehicle
        print(
            f"seed {seed}: vehicle {info['vehicle']} of {drawn.rigid_body.mass:.2f} kg, "
            f"{info['position_error']:.2f} m from the goal"
        )
    observation, *_ = env.step(env.action_space.sample())
    print("ages of the readings [s]:", observation[-3:])


if __name__ == "__main__":
    main()
