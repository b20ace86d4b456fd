"""The package as users get it: its list of packages, its light import, its registrations."""

import subprocess
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).parents[1]


def python(program):
    result = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    return result.stdout.strip()


def test_the_list_of_packages_is_that_of_the_folders():
    settings = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["setuptools"]
    folders = {
        ".".join(path.parent.relative_to(ROOT).parts)
        for top in ("dq_marine", "envs", "agents")
        for path in (ROOT / top).rglob("__init__.py")
    }
    found = {name if name.startswith("dq_marine") else f"dq_marine.{name}" for name in folders}
    assert sorted(found) == settings["packages"]


def test_the_links_point_to_the_folders():
    for name in ("envs", "agents"):
        link = ROOT / "dq_marine" / name
        assert link.is_symlink()
        assert link.resolve() == ROOT / name


def test_import_is_light():
    heavy = ("numba", "torch", "meshcat", "scipy", "pydantic", "stable_baselines3", "matplotlib", "IPython")
    program = f"import sys, dq_marine; print([name for name in {heavy} if name in sys.modules])"
    assert python(program) == "[]"


def test_stepping_needs_only_the_core():
    """Nothing of the extras is imported to make, reset and step an environment."""
    program = (
        "import sys, gymnasium\n"
        "env = gymnasium.make('dq_marine:dq_marine/StationKeeping-v0')\n"
        "env.reset(seed=0); env.step(env.action_space.sample()); env.close()\n"
        "extras = ('torch', 'meshcat', 'stable_baselines3', 'matplotlib', 'zmq', 'PIL')\n"
        "print([name for name in extras if name in sys.modules])\n"
    )
    assert python(program) == "[]"


def test_the_version_is_that_of_the_project():
    import dq_marine

    assert dq_marine.__version__ == tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["version"]
