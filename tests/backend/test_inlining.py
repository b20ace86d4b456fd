"""Functions that go into others become machine code once, with the whole, and compute the same."""

import subprocess
import sys

import numba
import numpy as np
import pytest
from numba.core.codegen import JITCodeLibrary
from numba.extending import register_jitable

from dq_marine.backend.inlining import INLINED, TRIED_VERSIONS, inlining_options

PROGRAM = """
import numba
numba.version_info = numba.version_info._replace(short={short})
from numba.core.typed_passes import NativeLowering
lowered, run_pass = [], NativeLowering.run_pass
NativeLowering.run_pass = lambda step, state: lowered.append(state.func_id.func_qualname) or run_pass(step, state)
from dq_marine.backend.inlining import INLINED
from dq_marine.simulation.scene import Scene
body = Scene(current={current}).stepper()
body.step((1.0, 2.0, 0.0, 0.1, 0.0, 0.3), 50)
print("pipeline_class" in INLINED, len(lowered), body.get_state().tobytes().hex())
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


def test_parts_that_scenes_share_are_kept_and_other_versions_compile_to_the_same_bits(tmp_path, monkeypatch):
    def run(cache, short, current):
        monkeypatch.setenv("DQ_MARINE_CACHE_DIR", str(tmp_path / cache))
        program = PROGRAM.format(short=short, current=current)
        done = subprocess.run(
            [sys.executable, "-c", program], capture_output=True, text=True, check=True, timeout=300
        )
        links, lowered, state = done.stdout.split()
        return links == "True", int(lowered), state

    flow = (0.1, 0.2, 0.0)
    _, first, _ = run("kept", numba.version_info.short, (0.0, 0.0, 0.0))
    links, second, state = run("kept", numba.version_info.short, flow)
    plainly_links, plainly, plain_state = run("plain", (0, 0), flow)
    assert (links, plainly_links) == (True, False)
    assert second < 0.25 * first
    assert second < 0.25 * plainly
    assert state == plain_state
