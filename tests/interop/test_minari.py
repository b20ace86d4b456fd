"""Minari records data sets with infos."""

from support.minari_child import needs_minari, printed_by

RECORDED = """
import gymnasium as gym
import minari
import numpy as np
import dq_marine

env = minari.DataCollector(gym.make("dq_marine/StationKeeping-v0", max_episode_steps=7), record_infos=True)
given = []
for seed in range(2):
    infos = [env.reset(seed=seed)[1]]
    over = False
    while not over:
        _, _, terminated, truncated, info = env.step(env.action_space.sample())
        infos.append(info)
        over = terminated or truncated
    given.append(infos)

def flat(infos):
    # A name with a slash comes back as a dictionary in a dictionary: Minari writes groups of an HDF5 file.
    for name, value in infos.items():
        if isinstance(value, dict):
            yield from ((f"{name}/{inner}", row) for inner, row in flat(value))
        else:
            yield name, value


data = env.create_dataset(
    dataset_id="dq_marine/test-v0", algorithm_name="random", author="nobody", author_email="none", code_permalink="none"
)
assert data.total_episodes == 2, data.total_episodes
for episode, infos in zip(minari.load_dataset("dq_marine/test-v0").iterate_episodes(), given, strict=True):
    assert len(episode.rewards) == len(infos) - 1
    recorded = dict(flat(episode.infos))
    assert set(infos[0]) == set(recorded), (set(infos[0]), set(recorded))
    for name, rows in recorded.items():
        assert np.array_equal(np.squeeze(rows), np.array([info[name] for info in infos])), name
print("recorded", sorted(infos[0]))
"""


@needs_minari
def test_infos_are_recorded_and_read_again(tmp_path):
    assert "position_error" in printed_by(RECORDED, datasets=str(tmp_path))
