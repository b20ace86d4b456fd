"""Pure functions run in plain Python, without NumPy or Numba, and say the same as compiled."""

import subprocess
import sys

import numpy as np
from support.bodies import make_body, random_inertia, random_quaternion

from dq_marine.algebra.spatial import from_fossen
from dq_marine.backend.packing import pack
from dq_marine.integrator.step import make_advance

PURE = ("algebra", "integrator", "physics/*/formulas*", "task")
"""Folders of plain functions, below `dq_marine`."""

NOT_PURE = ("task/sensors/build.py", "task/sensors/sensor.py")
"""What checks the numbers that a user gives to sensors."""


def test_pure_folders_import_only_themselves_and_the_standard_library():
    program = (
        "import sys, importlib, types, pathlib\n"
        "root = pathlib.Path(sys.argv[1])\n"
        "package = types.ModuleType('dq_marine'); package.__path__ = [str(root)]\n"
        "sys.modules['dq_marine'] = package\n"
        f"files = [file for folder in {PURE!r} for found in root.glob(folder)\n"
        "    for file in ([found] if found.suffix else found.rglob('*.py'))\n"
        f"    if file.relative_to(root).as_posix() not in {NOT_PURE!r}]\n"
        "assert len(files) > 40\n"
        "for file in files:\n"
        "    importlib.import_module('.'.join(('dq_marine', *file.relative_to(root).with_suffix('').parts)))\n"
        "print(sorted(n for n in ('numpy', 'numba', 'gymnasium', 'pydantic') if n in sys.modules))\n"
    )
    import dq_marine

    result = subprocess.run(
        [sys.executable, "-c", program, dq_marine.__path__[0]], capture_output=True, text=True, check=True
    )
    assert result.stdout.strip() == "[]"


def test_plain_python_and_compiled_agree_bit_for_bit():
    rng = np.random.default_rng(0)
    body = make_body(
        random_inertia(rng),
        0.05,
        excess_weight=1.0,
        arm=(0.1, 0.2, 2.0),
        quadratic=rng.uniform(size=6),
        current=(0.3, 0.1, 0.0),
    )
    body.reset(rng.normal(size=3), random_quaternion(rng), rng.normal(size=6))
    wrench = rng.normal(size=6)
    plain = make_advance(body._composition)(body.parameters, body.state, from_fossen(tuple(wrench)), 0.0, 7)
    body.step(wrench, 7)
    assert np.array_equal(pack(plain.state), body.get_state()[1:])
