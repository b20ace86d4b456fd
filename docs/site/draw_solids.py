"""Draw an ROV that has landed on the seabed among solids: `python docs/site/draw_solids.py`.

It needs the extra `render` and a Chromium.
"""

from __future__ import annotations

from pathlib import Path

import gymnasium as gym
import numpy as np
from PIL import Image

import dq_marine  # registers the tasks

FILE = Path(__file__).parents[1] / "images" / "landed.png"

DEPTH = 6.5
"""Of the seabed [m]."""

SOLIDS = (
    dq_marine.Solid(dq_marine.Plane(), (0.0, 0.0, DEPTH)),
    dq_marine.Solid(dq_marine.Ball(0.55), (1.3, -0.4, DEPTH + 0.15)),
    dq_marine.Solid(dq_marine.Pillar(0.3), (1.6, 1.5, 0.0)),
    dq_marine.Solid(dq_marine.Box((1.0, 0.6, 0.5)), (0.3, 2.0, DEPTH - 0.25), heading=0.4),
    dq_marine.Solid(dq_marine.Rod((2.4, -0.6, 0.0), 0.08), (-0.4, -1.3, DEPTH - 0.08)),
)


def main(file: Path = FILE) -> None:
    """Press the vehicle down for eight seconds, and draw it."""
    env = gym.make(
        "dq_marine/StationKeeping-v0", render_mode="rgb_array", current=[0.2, 0.0, 0.0], solids=SOLIDS
    )
    env.reset(seed=1)
    for _ in range(80):
        env.step(np.array([0.0, 0.0, 0.7, 0.0, 0.0, 0.0], dtype=np.float32))
    Image.fromarray(env.render()).save(file, optimize=True)
    env.close()


if __name__ == "__main__":
    main()
