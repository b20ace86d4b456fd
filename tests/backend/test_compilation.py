"""Compiled code on disk follows the sources, and the terms of the scene."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from support.bodies import make_body
from support.counting import counted, operations_of

import dq_marine
from dq_marine import CurrentProfile
from dq_marine.algebra.spatial import from_fossen
from dq_marine.backend.fingerprint import all_used_functions
from dq_marine.integrator.kick import undamped_kick
from dq_marine.integrator.midpoint_drift import midpoint_drift, midpoint_fallback
from dq_marine.integrator.step import Composition, make_advance
from dq_marine.integrator.strang import make_strang
from dq_marine.physics.current.formulas.uniform import STILL_WATER
from dq_marine.simulation.scene import Scene

M = np.diag([20.0, 25.0, 30.0, 1.0, 1.5, 2.0])
PROGRAM = """
import numpy as np
from dq_marine.report.methods import METHODS
from dq_marine.report.physics import Physics

body = METHODS["rk4_quaternion"].body(Physics(np.diag([20.0] * 6), excess_weight=5.0), 0.02)
body.step(np.zeros(6), 50)
print(body.position_ned[2])
"""
"""A body that sinks, by the method that compiles soonest."""


def operations(body):
    """Arithmetic operations of one step of a body."""
    body.reset(velocity_body=(0.3, -0.2, 0.1, 0.05, 0.04, -0.03))
    advance = make_advance(body._composition)
    wrench = counted(from_fossen((1.0, 2.0, 3.0, 0.1, 0.2, 0.3)))
    return operations_of(advance, counted(body.parameters), counted(body.state), wrench, 0.0, 1)


def test_an_absent_term_costs_nothing():
    """A scene without a term runs the very function of a scene that never heard of it; a present term costs."""
    bare = make_body(M, 0.02)
    assert bare._composition == Composition(
        make_strang, (), (), undamped_kick, midpoint_drift, midpoint_fallback, STILL_WATER
    )
    zero = make_body(
        M, 0.02, excess_weight=0.0, arm=np.zeros(3), linear=np.zeros((6, 6)), current=np.zeros(3)
    )
    assert zero._advance is bare._advance
    assert operations(zero) == operations(bare)
    for term in (
        {"excess_weight": 1.0},
        {"arm": (0.0, 0.0, 1.0)},
        {"linear": np.eye(6)},
        {"quadratic": np.ones(6)},
        {"current": (0.1, 0.0, 0.0)},
    ):
        assert operations(make_body(M, 0.02, **term)) > operations(bare)


def test_diagonal_damping_does_not_multiply_by_zeros():
    diagonal = make_body(M, 0.02, linear=np.eye(6), quadratic=np.ones(6))
    full = make_body(M, 0.02, linear=np.eye(6) + 0.01, quadratic=np.ones(6))
    assert operations(diagonal) < 0.75 * operations(full)


def test_what_a_scene_lacks_is_not_used():
    bare = {
        function.__name__ for function in all_used_functions(make_advance(make_body(M, 0.02)._composition))
    }
    assert {"drift", "split_drift", "drift_equation"} <= bare
    absent = {"net_weight", "righting_moment", "quadratic_kick", "linear_kick", "carry_with_current"}
    assert not bare & absent
    full = {
        function.__name__
        for function in all_used_functions(make_advance(Scene(current=(1, 0, 0)).composition))
    }
    assert absent - {"linear_kick"} <= full


def test_methods_with_stages_have_of_the_water_what_the_scene_has():
    """Uniform water is none of their forces, changes nothing about their steps, and is used as it is."""
    sheared = {"forces_in_shear", "step_from_start", "shear_force", "carry_from_depth", "slip"}
    accelerating = {"forces_in_accelerating_water", "carry_unsteadily"}
    profile = CurrentProfile([0.0, 9.0], [[0.5, 0.0], [0.0, 0.0]])
    for scheme, order in (("gauss", 8), ("galerkin", 4), ("runge_kutta", 8)):
        used = {}
        for name, current in (("still", (0, 0, 0)), ("uniform", (1, 0, 0)), ("profile", profile)):
            advance = make_advance(Scene(scheme=scheme, order=order, current=current).composition)
            used[name] = {function.__name__ for function in all_used_functions(advance)}
        assert used["uniform"] - used["still"] <= {"carry_with_current", "pose_translate", "displace"}
        assert not (used["still"] | used["uniform"]) & (sheared | accelerating)
        assert sheared <= used["profile"]
        assert not used["profile"] & accelerating


def test_terms_present_but_zero_give_the_same_trajectory():
    """Vanishing coefficients through the full step, against the bare step."""
    tiny = 1e-300
    full = make_body(
        M, 0.02, excess_weight=tiny, arm=(tiny, 0, 0), linear=tiny * np.ones((6, 6)), quadratic=np.full(6, tiny),
        current=(tiny, 0, 0),
    )  # fmt: skip
    bare = make_body(M, 0.02)
    for body in (full, bare):
        body.reset((1.0, 2.0, 3.0), (0.6, 0.0, 0.8, 0.0), (0.3, -0.2, 0.1, 0.5, 0.4, -0.3))
        body.step((1.0, 2.0, 3.0, 0.1, 0.2, 0.3), 200)
    assert np.allclose(full.get_state(), bare.get_state(), rtol=0, atol=1e-11)


def run(folder, cache):
    environment = os.environ | {"PYTHONPATH": str(folder), "DQ_MARINE_CACHE_DIR": str(cache)}
    return subprocess.run(
        [sys.executable, "-c", PROGRAM],
        capture_output=True,
        text=True,
        check=True,
        env=environment,
        cwd=folder,
    )


@pytest.mark.slow
def test_the_cache_follows_the_sources(tmp_path):
    """A second process loads what the first compiled; an edited callee in another file is noticed."""
    own = Path(dq_marine.__file__).parent
    copied = tmp_path / "src" / "dq_marine"
    shutil.copytree(own, copied, ignore=shutil.ignore_patterns("__pycache__"))
    cache = tmp_path / "cache"
    first = run(copied.parent, cache)
    assert "compiling" in first.stderr
    second = run(copied.parent, cache)
    assert "compiling" not in second.stderr
    assert second.stdout == first.stdout
    restoring = copied / "physics" / "hydrostatics" / "formulas" / "submerged.py"
    text = restoring.read_text()
    edited = text.replace("scale(term.force, ", "scale(-term.force, ")
    assert edited != text
    restoring.write_text(edited)
    third = run(copied.parent, cache)
    assert "compiling" in third.stderr
    assert float(third.stdout) == pytest.approx(-float(first.stdout), rel=1e-6)


def test_an_unwritable_cache_is_said_and_does_not_stop(tmp_path):
    blocked = tmp_path / "file"
    blocked.write_text("not a folder")
    environment = os.environ | {"DQ_MARINE_CACHE_DIR": str(blocked)}
    program = (
        "from dq_marine.backend.compilation import compile_function\n"
        "def double(x): return 2.0 * x\n"
        "print(compile_function(double, 'test')(4.0))\n"
    )
    script = tmp_path / "script.py"
    script.write_text(program)
    result = subprocess.run(
        [sys.executable, str(script)], capture_output=True, text=True, check=True, env=environment
    )
    assert result.stdout.strip() == "8.0"
    assert "DQ_MARINE_CACHE_DIR" in result.stderr
