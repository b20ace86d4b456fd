"""Run outside the repository with only the core installed: the wheel is complete and the extras are optional."""

import ast
import importlib
import importlib.metadata
import importlib.util
import re
import subprocess
import sys
from pathlib import Path

import gymnasium
import numpy as np

import dq_marine
from dq_marine import MissingDependencyError, Scene, load_vehicle, vehicle_names

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

for name in (*vehicle_names(), "rexrov_published"):
    load_vehicle(name)
assert load_vehicle("supply_vessel").radiation is not None

assert len(dq_marine.scenario_names()) >= 20
dq_marine.make_scenario("StationKeeping/calm").reset()

# A wheel's long description is the README: every name of ours that its Python code imports must be there. Those that
# need an extra say which; all others need only the core.
EXTRAS = {
    "dq_marine.ThrustAllocator": "allocation",
    "dq_marine.agents.MarineVecEnv": "agents",
    "dq_marine.envs.parallel_env": "multi",
}
metadata = importlib.metadata.metadata("dq-marine")
readme = metadata["Description"] or str(metadata.get_payload())
imports = {
    (node.module, alias.name)
    for block in re.findall(r"```python\n(.*?)```", readme, re.DOTALL)
    for node in ast.walk(ast.parse(block))
    if isinstance(node, ast.ImportFrom) and str(node.module).split(".")[0] == "dq_marine"
    for alias in node.names
}
assert len(imports) >= 10, f"the README imports only {sorted(imports)}"
for module, name in sorted(imports):
    public, extra = f"{module}.{name}", EXTRAS.get(f"{module}.{name}")
    try:
        getattr(importlib.import_module(module), name)
    except MissingDependencyError as error:
        assert extra is not None, f"{public} needs more than the core: {error}"
        assert f'pip install "dq-marine[{extra}]"' in str(error), error
    else:
        assert extra is None, f"{public} needs no extra: take it out of EXTRAS"

command = Path(sys.executable).parent / "dq-marine"
for arguments in (["--help"], ["vehicles"]):
    subprocess.run([command, *arguments], check=True, stdout=subprocess.DEVNULL)
print(f"dq-marine {dq_marine.__version__}: the wheel works with only the core installed")
