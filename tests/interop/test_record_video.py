"""Gymnasium's `RecordVideo` writes what an environment draws."""

import os
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

RECORDED = """
import gymnasium as gym
import imageio_ffmpeg
from gymnasium.wrappers import RecordVideo
import dq_marine

env = gym.make("dq_marine/StationKeeping-v0", render_mode="rgb_array", max_episode_steps=4)
env = RecordVideo(env, "videos", episode_trigger=lambda episode: True)
env.reset(seed=0)
over = False
while not over:
    _, _, terminated, truncated, _ = env.step(env.action_space.sample())
    over = terminated or truncated
env.close()
said = next(imageio_ffmpeg.read_frames("videos/rl-video-episode-0.mp4"))
print(said["size"], said["fps"], imageio_ffmpeg.count_frames_and_secs("videos/rl-video-episode-0.mp4")[0])
"""


@pytest.mark.browser
@pytest.mark.skipif(not find_spec("moviepy"), reason="needs the extra `interop`")
def test_gymnasium_records_videos(tmp_path):
    """In a process of its own: MoviePy warns of what newer Pythons dislike in it."""
    root = Path(__file__).parents[2]
    result = subprocess.run(
        [sys.executable, "-c", RECORDED],
        capture_output=True,
        text=True,
        cwd=tmp_path,
        env=os.environ | {"PYTHONPATH": str(root)},
        timeout=1800,
    )
    assert result.returncode == 0, result.stderr
    assert result.stdout.split("\n")[-2] == "(640, 480) 10.0 5"
