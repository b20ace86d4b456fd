"""The public names: each resolves, is listed once, and costs nothing before it is used."""

import ast
import importlib
import pkgutil
import subprocess
import sys
from pathlib import Path

import pytest

from dq_marine.util.lazy_names import public_names

PACKAGES = ("dq_marine", "dq_marine.agents", "dq_marine.envs")
HEAVY = ("numba", "torch", "meshcat", "scipy", "pydantic", "stable_baselines3", "matplotlib", "IPython")


@pytest.mark.parametrize("package", PACKAGES)
def test_every_public_name_resolves_to_what_its_module_defines(package):
    module = importlib.import_module(package)
    names = public_names(module.__file__)
    assert set(module.__all__) - {"__version__"} == set(names)
    assert len(module.__all__) == len(set(module.__all__))
    for name, source in names.items():
        assert getattr(module, name) is getattr(importlib.import_module(source), name)
        assert name in dir(module)


@pytest.mark.parametrize("package", PACKAGES)
def test_no_public_name_is_that_of_a_module_beside_it(package):
    """Importing the module would put it in the place of the name."""
    module = importlib.import_module(package)
    assert not set(public_names(module.__file__)) & {
        found.name for found in pkgutil.iter_modules(module.__path__)
    }


@pytest.mark.parametrize("package", PACKAGES)
def test_the_stub_makes_every_name_public_under_its_own_name(package):
    """Type checkers re-export from a stub only what is imported as itself."""
    tree = ast.parse(Path(importlib.import_module(package).__file__).with_suffix(".pyi").read_text())
    aliases = [alias for node in tree.body if isinstance(node, ast.ImportFrom) for alias in node.names]
    assert aliases
    assert [alias.name for alias in aliases] == [alias.asname for alias in aliases]


@pytest.mark.parametrize("package", PACKAGES)
def test_an_unknown_name_is_an_attribute_error(package):
    module = importlib.import_module(package)
    with pytest.raises(AttributeError, match=f"module '{package}' has no attribute 'Sceen'"):
        module.Sceen  # noqa: B018
    with pytest.raises(ImportError, match="Sceen"):
        exec(f"from {package} import Sceen")


@pytest.mark.parametrize("package", PACKAGES)
def test_listing_the_names_imports_none_of_them(package):
    program = f"import sys, {package}; dir({package}); print([m for m in {HEAVY} if m in sys.modules])"
    result = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert result.stdout.strip() == "[]"


def test_importing_dq_marine_adds_only_its_own_modules_to_gymnasium():
    """`import dq_marine` stays below 0.2 s, because all but a few hundredths of it are Gymnasium's and NumPy's."""
    program = (
        "import sys, gymnasium; before = set(sys.modules); import dq_marine;"
        "added = {name.partition('.')[0] for name in set(sys.modules) - before};"
        "print(sorted(added - set(sys.stdlib_module_names) - {'dq_marine', 'numpy', 'gymnasium'}))"
    )
    result = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert result.stdout.strip() == "[]"
