"""How fast one body steps, and what each term of a scene adds, on one core.

Run: python benchmarks/one_body_rate.py [--json FILE]

Times are medians over rounds; rounds of the different scenes alternate, so that a ratio holds when the machine's speed
drifts.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import statistics
import time
from collections.abc import Callable
from importlib.metadata import version
from pathlib import Path

import gymnasium as gym
import numpy as np

import dq_marine  # noqa: F401 - registers the environments
from dq_marine.report.lean_scenes import changed, neutral
from dq_marine.scene import Scene
from dq_marine.vehicles import load_vehicle

ROUNDS = 15
STEPS = 5_000  # 100 s: a heavy body without damping does not fall fast yet


def physics(scene: Scene) -> Callable[[], float]:
    """Return a function that measures seconds a step within one call."""
    body = scene.stepper()

    def measure() -> float:
        body.reset(velocity_body=(0.3, 0.1, 0.05, 0.1, 0.2, 0.1))
        start = time.perf_counter()
        body.step(steps=STEPS)
        return (time.perf_counter() - start) / STEPS

    return measure


def environment(env: gym.Env) -> Callable[[], float]:
    """Return a function that measures seconds an environment step, resets included."""
    action = np.zeros(6, dtype=np.float32)
    env.reset(seed=0)

    def measure() -> float:
        start = time.perf_counter()
        for _ in range(STEPS):
            _, _, terminated, truncated, _ = env.step(action)
            if terminated or truncated:
                env.reset()
        return (time.perf_counter() - start) / STEPS

    return measure


def cases() -> dict[str, Callable[[], float]]:
    """Return what is measured, by name."""
    own = load_vehicle("bluerov2_heavy")
    bare = neutral(own)
    heavy = changed(bare, "buoyancy", volume=own.buoyancy.volume)
    righted = changed(bare, "buoyancy", center=own.buoyancy.center)
    linear = changed(bare, "damping", linear=own.damping.linear)
    quadratic = changed(linear, "damping", quadratic=own.damping.quadratic)
    made = gym.make("dq_marine/StationKeeping-v0")
    return {
        "inertia alone": physics(Scene(bare)),
        "+ net weight": physics(Scene(heavy)),
        "+ righting moment": physics(Scene(righted)),
        "+ current": physics(Scene(bare, current=(0.3, 0.0, 0.0))),
        "+ linear damping": physics(Scene(linear)),
        "+ linear and quadratic damping": physics(Scene(quadratic)),
        "everything": physics(Scene(own, current=(0.3, 0.0, 0.0))),
        "env.step, bare (4 substeps)": environment(made.unwrapped),
        "env.step, through gym.make": environment(made),
    }


def main() -> None:
    """Measure, print a table, and write the numbers if asked."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--json", type=Path, help="write the numbers to this file")
    arguments = parser.parse_args()
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    measured = cases()
    rounds = [{name: measure() for name, measure in measured.items()} for _ in range(ROUNDS)]
    medians = {name: statistics.median(each[name] for each in rounds) for name in measured}
    base = medians["inertia alone"]
    versions = ", ".join(f"{name} {version(name)}" for name in ("numpy", "numba", "gymnasium"))
    print(
        f"{platform.processor() or platform.machine()}, one core; Python {platform.python_version()}, {versions}"
    )
    print(f"{'':34}{'time':>10}{'rate':>14}{'ratio':>8}")
    for name, seconds in medians.items():
        print(f"{name:34}{seconds * 1e9:>7.0f} ns{1.0 / seconds:>12,.0f}/s{seconds / base:>8.2f}")
    if arguments.json:
        arguments.json.write_text(json.dumps(medians, indent=2))


if __name__ == "__main__":
    main()
