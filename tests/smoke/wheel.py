"""Run outside the repository with only the core installed: the wheel is complete and the extras are optional."""

import importlib.util
import subprocess
import sys
from pathlib import Path

import gymnasium
import numpy as np

import dq_marine
from dq_marine.errors import MissingDependencyError
from dq_marine.scene import Scene
from dq_marine.vehicles import load_vehicle, vehicle_names

assert "site-packages" in dq_marine.__file__, dq_marine.__file__
for extra in ("torch", "stable_baselines3", "meshcat", "matplotlib"):
    assert importlib.util.find_spec(extra) is None, f"{extra} is installed; this check is for the core alone"

env = gymnasium.make("dq_marine/StationKeeping-v0")
env.reset(seed=0)
for _ in range(100):
    observation, *_ = env.step(env.action_space.sample())
assert np.isfinite(observation).all()

pictures = gymnasium.make("dq_marine/StationKeeping-v0", render_mode="rgb_array")
pictures.reset(seed=0)
try:
    pictures.render()
except MissingDependencyError as error:
    assert "dq-marine[render]" in str(error), error
else:
    raise AssertionError("rendering without meshcat should have been refused")

body = Scene().stepper()
body.step((10.0, 0.0, 0.0, 0.0, 0.0, 0.0), 50)
assert body.position_ned[0] > 0.0

for name in vehicle_names():
    load_vehicle(name)
assert load_vehicle("supply_vessel").radiation is not None

command = Path(sys.executable).parent / "dq-marine"
for arguments in (["--help"], ["vehicles"]):
    subprocess.run([command, *arguments], check=True, stdout=subprocess.DEVNULL)
print(f"dq-marine {dq_marine.__version__}: the wheel works with only the core installed")
