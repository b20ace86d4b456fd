"""Functions that go into others become machine code once, with the whole, and compute the same."""

import subprocess
import sys

import numba
import numpy as np
import pytest
from numba.core.codegen import JITCodeLibrary
from numba.extending import register_jitable
from support.sweeps import sweep

from dq_marine.backend.inlining import INLINED, TRIED_VERSIONS, inlining_options

PROGRAM = """
import numba
numba.version_info = numba.version_info._replace(short={short})
from numba.core.typed_passes import NativeLowering
lowered, run_pass = [], NativeLowering.run_pass
NativeLowering.run_pass = lambda step, state: lowered.append(state.func_id.func_qualname) or run_pass(step, state)
from dq_marine.backend.inlining import INLINED
{composition}
print("pipeline_class" in INLINED, len(lowered), result.hex())
"""

POSES = """
import numpy as np
from dq_marine.algebra.dual_quaternion import dual_conjugate, dual_multiply, pose_position, pose_renormalise
from dq_marine.algebra.screw import pose_exp
from dq_marine.algebra.spatial import Spatial
from dq_marine.backend.compilation import compile_function

def there(motion, times):
    pose = step = pose_exp(motion)
    for _ in range(times):
        pose = pose_renormalise(dual_multiply(pose, step))
    return pose_position(pose)

def back(motion, times):
    pose = step = pose_exp(motion)
    for _ in range(times):
        pose = pose_renormalise(dual_multiply(dual_conjugate(step), pose))
    return pose_position(pose)

motion = Spatial((0.1, 0.2, 0.3), (1.0, 0.0, 2.0))
result = np.array(compile_function({}, "test")(motion, 9)).tobytes()
"""
"""Two functions that share most of what they are made of."""

SCENES = """
from dq_marine.simulation.scene import Scene
body = Scene(current={}).stepper()
body.step((1.0, 2.0, 0.0, 0.1, 0.0, 0.3), 50)
result = body.get_state().tobytes()
"""


def nested(options):
    """A compiled function with two others within it, and how often machine code was made for it."""

    def add_squares(a, b):
        return a * a + b * b

    register_jitable(**options)(add_squares)

    def length(triple):
        return np.sqrt(add_squares(add_squares(triple[0], triple[1]) ** 0.5, triple[2]))

    register_jitable(**options)(length)

    @numba.njit(error_model="numpy")
    def mean_length(triples):
        total = 0.0
        for triple in triples:
            total += length(triple)
        return total / len(triples)

    return mean_length


def machine_codes(monkeypatch, compiled, *arguments):
    """What a function returns, and how often it was made into machine code."""
    made = []
    make = JITCodeLibrary._finalize_specific
    with monkeypatch.context() as patched:
        patched.setattr(
            JITCodeLibrary, "_finalize_specific", lambda library: made.append(library.name) or make(library)
        )
        return compiled(*arguments), sum("nested" in name for name in made)


def test_machine_code_is_made_once(monkeypatch):
    triples = tuple(tuple(row) for row in np.random.default_rng(3).standard_normal((5, 3)))
    mean, number = machine_codes(monkeypatch, nested(INLINED), triples)
    plain_mean, plain_number = machine_codes(monkeypatch, nested(inlining_options((0, 0))), triples)
    assert (number, plain_number) == (1, 3)
    assert mean == plain_mean == pytest.approx(np.mean([np.linalg.norm(triple) for triple in triples]))


def test_the_installed_numba_was_tried():
    """Else each step takes twice as long to compile: run these tests with it, and add its version."""
    assert numba.version_info.short in TRIED_VERSIONS


@pytest.mark.parametrize(
    ("program", "first", "second"),
    sweep(
        [(POSES, "there", "back"), (SCENES, (0.0, 0.0, 0.0), (0.1, 0.2, 0.0))],
        plain=[(POSES, "there", "back")],
    ),
)
def test_parts_that_are_shared_are_kept_and_other_versions_compile_to_the_same_bits(
    tmp_path, monkeypatch, program, first, second
):
    def run(cache, short, chosen):
        monkeypatch.setenv("DQ_MARINE_CACHE_DIR", str(tmp_path / cache))
        source = PROGRAM.format(short=short, composition=program.format(chosen))
        done = subprocess.run(
            [sys.executable, "-c", source], capture_output=True, text=True, check=True, timeout=300
        )
        links, lowered, result = done.stdout.split()
        return links == "True", int(lowered), result

    _, lowered_first, _ = run("kept", numba.version_info.short, first)
    links, lowered_second, result = run("kept", numba.version_info.short, second)
    plainly_links, lowered_plainly, plain_result = run("plain", (0, 0), second)
    assert (links, plainly_links) == (True, False)
    assert lowered_second < 0.25 * lowered_first
    assert lowered_second < 0.25 * lowered_plainly
    assert result == plain_result
