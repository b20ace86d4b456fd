"""The step of a batch is made of vector instructions, on the widest registers that there are: seen in its assembly."""

import dataclasses
import math
import re
from collections import Counter

import numpy as np
import pytest
from numba.core.registry import cpu_target
from support.bodies import make_body
from support.child_compilation import HERE

from dq_marine.integrator.drift_report import DriftReport, SolverReport
from dq_marine.simulation.batch import Batch
from dq_marine.simulation.one_body import OneBody
from dq_marine.simulation.scene import Scene

pytestmark = pytest.mark.sweep  # what a step computes is tried in a plain run, how fast is not

MOSTLY = 0.95
"""What is scalar are sums and products of numbers that all bodies share."""

X86 = re.compile(r"^\s+v?(add|sub|mul|div|sqrt|max|min|fn?m(?:add|sub)+\d+)([ps]d)\s(.*)$", re.MULTILINE)
ARM = re.compile(
    r"^\s+f(n?m(?:add|sub|la|ls)|n?mul|add|sub|div|sqrt|max\w*|min\w*)(\.2d)?\s+([dv]\d+.*)$", re.MULTILINE
)


def no_fallback(inertia, h, pose, momentum):
    """Takes the place of the fallback, which is for one body at a time, and which LLVM may inline."""
    return pose, momentum, DriftReport(SolverReport(math.inf, False, 0), False)


def without_fallback(composition):
    return dataclasses.replace(composition, fallback=no_fallback)


def assembly_of(stepper):
    """Assembly of a batch's or body's step; it is there where code was not read from disk."""
    stepper.step()
    (text,) = stepper._advance.inspect_asm().values()
    return text


def batch_assembly(composition, parameters, arithmetic):
    return assembly_of(Batch(without_fallback(composition), [parameters], 0.02, 8, arithmetic=arithmetic))


@pytest.fixture(scope="module")
def texts(tmp_path_factory):
    """Assemblies by name, of code that is kept in a folder of its own."""
    scene, bare = Scene(current=(0.2, -0.1, 0.05)), make_body(np.diag([5.0, 6.0, 7.0, 1.0, 2.0, 3.0]), 0.02)
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("DQ_MARINE_CACHE_DIR", str(tmp_path_factory.mktemp("compiled")))
        patch.setenv(HERE, "1")
        return {  # the full scene, and twice the smallest, which does not take long
            "strict": batch_assembly(scene.composition, scene.parameters_at(0.02), "strict"),
            "fast": batch_assembly(bare._composition, bare.parameters, "fast"),
            "one body": assembly_of(OneBody(without_fallback(bare._composition), bare._parameters_at, 0.02)),
        }


def arithmetic_in(text):
    """Count instructions that compute in double precision, by what they do and the registers they do it on."""
    found = Counter((name, operands) for name, operands in _instructions(text))
    assert found.total() > 500, "the assembly has another syntax"
    return found


def _instructions(text):
    for name, kind, operands in X86.findall(text):
        yield name, "scalar" if kind == "sd" else re.search(r"[xyz]mm", operands)[0]
    for name, suffix, operands in ARM.findall(text):
        yield name, "neon" if suffix or ".2d" in operands else "scalar"


def packed_share(found):
    return sum(count for (_, register), count in found.items() if register != "scalar") / found.total()


def fused_in(found):
    return sum(count for (name, _), count in found.items() if re.match(r"n?m(add|sub|la|ls)|fn?m", name))


def widest_register():
    """Name of the widest registers of the processor that Numba compiles for."""
    triple, _, features = cpu_target.target_context.codegen().magic_tuple()
    if "x86_64" not in triple:
        return "neon"
    return "zmm" if "+avx512f" in features else "ymm" if "+avx," in features else "xmm"


def test_a_batchs_arithmetic_is_packed(texts):
    found = arithmetic_in(texts["strict"])
    assert packed_share(found) > MOSTLY, found


def test_it_is_done_on_the_widest_registers(texts):
    found = arithmetic_in(texts["strict"])
    widest = sum(count for (_, register), count in found.items() if register == widest_register())
    assert widest > MOSTLY * found.total(), found


def test_one_bodys_arithmetic_is_not_packed(texts):
    """The same measure, where there is nothing to be packed."""
    assert packed_share(arithmetic_in(texts["one body"])) < 0.5


def test_multiply_adds_are_fused_in_fast_arithmetic_alone(texts):
    assert fused_in(arithmetic_in(texts["strict"])) == 0
    assert fused_in(arithmetic_in(texts["one body"])) == 0
    triple, _, features = cpu_target.target_context.codegen().magic_tuple()
    if "x86_64" not in triple or "+fma" in features:
        assert fused_in(arithmetic_in(texts["fast"])) > 100
