"""Programs that use Minari, in a process of their own: it imports JAX, which does not like a process to fork."""

import os
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]

needs_minari = pytest.mark.skipif(
    not all(map(find_spec, ("minari", "h5py", "jax"))), reason="needs the extra `interop`"
)


def printed_by(program: str, *arguments: str, datasets: str) -> str:
    """Return what a program prints that ends well, with Minari's datasets in a folder."""
    found = [str(ROOT), str(ROOT / "tests"), *filter(None, [os.environ.get("PYTHONPATH")])]
    variables = os.environ | {
        "MINARI_DATASETS_PATH": datasets,
        "JAX_PLATFORMS": "cpu",
        "PYTHONPATH": os.pathsep.join(found),
    }
    child = subprocess.run(
        [sys.executable, "-c", program, *arguments],
        env=variables,
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert child.returncode == 0, child.stderr
    return child.stdout
