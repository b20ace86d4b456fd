"""Several vessels meet, each steered by the rules of the road. Needs the extra `multi` (PettingZoo).

python examples/several_vessels.py [episodes] [vessels]
"""

import sys

from dq_marine.agents import make_baseline
from dq_marine.envs import parallel_env


def main(episodes: int = 2, vessels: int = 3) -> None:
    """Let boats of 2 m meet, and count who came too near to whom, and who came to the end of its route."""
    env = parallel_env(("otter",) * vessels)
    agents = {name: make_baseline("controller", env.env_of(name)) for name in env.possible_agents}
    one = env.env_of(env.possible_agents[0])
    length, safe = one.vehicle.dimensions.length, one.safe_distance
    collisions, arrived, nearest = 0, 0, []
    for seed in range(episodes):
        observations, last = env.reset(seed=seed)
        for name, agent in agents.items():
            agent.reset(env.env_of(name))
        while env.agents:
            actions = {name: agents[name].act(observations[name]) for name in env.agents}
            observations, _, _, _, infos = env.step(actions)
            last = last | infos
        nearest.append(min(float(info["least_distance"]) for info in last.values()) / length)
        collisions += nearest[-1] < safe
        arrived += sum(bool(info["is_success"]) for info in last.values())
        print(f"episode {seed}: nearest {nearest[-1]:.2f} lengths")
    print(f"{collisions} of {episodes} episodes with a collision, nearest {min(nearest):.2f} lengths")
    print(
        f"{arrived} of {episodes * vessels} vessels at the end of their route, with others on the right side"
    )


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
