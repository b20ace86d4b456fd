"""The kernel runs in plain Python, without NumPy or Numba, and says the same as compiled."""

import subprocess
import sys

import numpy as np
from support.bodies import make_body, random_inertia, random_quaternion

from dq_marine.engines.packing import pack
from dq_marine.kernel.spatial import from_fossen
from dq_marine.kernel.step import make_advance


def test_the_kernel_imports_only_itself_and_the_standard_library():
    program = (
        "import sys, importlib, pkgutil, types\n"
        "package = types.ModuleType('dq_marine'); package.__path__ = [sys.argv[1]]\n"
        "sys.modules['dq_marine'] = package\n"
        "import dq_marine.kernel\n"
        "for module in pkgutil.iter_modules(dq_marine.kernel.__path__):\n"
        "    importlib.import_module('dq_marine.kernel.' + module.name)\n"
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
