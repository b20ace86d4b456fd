"""Compare agents on the same seeded episodes, as a table, a plot and a CSV file. The plot needs the extra `report`."""

import importlib.util
import tempfile
from pathlib import Path

import gymnasium as gym
from rich.console import Console

import dq_marine  # noqa: F401 - registers the environments
from dq_marine.agents import evaluate, fly_episode, make_baseline, score_table
from dq_marine.agents.evaluation.error_plot import save_plot
from dq_marine.agents.evaluation.trajectory import write_columns


def main() -> None:
    """Fly three episodes of 10 s with each of two agents."""
    env = gym.make("dq_marine/StationKeeping-v0", current=0.3, max_episode_steps=100)
    agents = {name: make_baseline(name, env) for name in ("zero", "controller")}
    Console(width=110).print(score_table(evaluate(env, agents, episodes=3, seed=0)))

    episode = fly_episode(env, agents["controller"], seed=1, track=True)
    print("settled after", episode.settling_time, "s")
    with tempfile.TemporaryDirectory() as folder:
        table = Path(folder) / "flight.csv"
        write_columns(episode.columns(), table)
        print(table.read_text().splitlines()[0])
        if importlib.util.find_spec("matplotlib") is not None:
            save_plot(episode, Path(folder) / "flight.png", title="DP controller, seed 1")
    # In a shell: dq-marine evaluate --agent zero --agent controller --episodes 100


if __name__ == "__main__":
    main()
