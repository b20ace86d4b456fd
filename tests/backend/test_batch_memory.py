"""What many bodies cost: memory for each, none that grows as they are stepped, and no compiling meanwhile."""

import concurrent.futures.thread
import gc
import tracemalloc
from functools import partial

import gymnasium as gym
import numpy as np
import pytest
from numba.core.runtime import _nrt_python, rtsys

import dq_marine  # noqa: F401 - registers
from dq_marine.backend import workers
from dq_marine.simulation.scene import Scene, batch_of
from dq_marine.vehicles import Vehicle, load_vehicle

CURRENT = (0.2, -0.1, 0.05)
CALLS = 200
GROWTH = CALLS * 8
"""Bytes: half of what one of Python's smallest objects, left behind by every call, would take."""


CALLING_COMPILED = [workers.__file__, concurrent.futures.thread.__file__]
"""Numba frees what it looks up a tuple's type with behind tracemalloc's back: some 30 kB seem to be held there."""

WITHOUT = [tracemalloc.Filter(False, name) for name in (tracemalloc.__file__, *CALLING_COMPILED)]


def bytes_held():
    """Bytes that Python holds for good."""
    gc.collect()
    statistics = tracemalloc.take_snapshot().filter_traces(WITHOUT).statistics("filename")
    return sum(statistic.size for statistic in statistics)


def taken_by(call, warm_up=50):
    """Bytes that Python holds after `CALLS` calls and did not before, and at most meanwhile.

    What every call leaves behind shows in each of three rounds. What one round alone shows is something else's: a
    table of Python's that grew, or what another thread of the process did.
    """
    tracemalloc.start()
    try:
        for _ in range(warm_up):
            call()
        bytes_held()  # which holds some itself
        rounds = [_round_of(call) for _ in range(3)]
        return min(growth for growth, _ in rounds), max(peak for _, peak in rounds)
    finally:
        tracemalloc.stop()


def _round_of(call):
    """Bytes that `CALLS` calls added, and the most that were held beyond those at the start."""
    before = bytes_held()
    base, _ = tracemalloc.get_traced_memory()
    tracemalloc.reset_peak()
    for _ in range(CALLS):
        call()
    _, peak = tracemalloc.get_traced_memory()
    return bytes_held() - before, peak - base


def allocations_in(call):
    """How often compiled code takes memory in a call, all of which it must give back."""
    _nrt_python.memsys_enable_stats()
    before = rtsys.get_allocation_stats()
    call()
    after = rtsys.get_allocation_stats()
    _nrt_python.memsys_disable_stats()
    taken, given_back, arrays_taken, arrays_given_back = (b - a for a, b in zip(before, after, strict=True))
    assert (taken, arrays_taken) == (given_back, arrays_given_back)
    return taken


def other_scene():
    """A scene that differs from the default vehicle's in every number that can."""
    content = load_vehicle("bluerov2_heavy").model_dump()
    content["rigid_body"]["mass"] *= 1.001
    content["buoyancy"]["center"] = (0.001, 0.002, -0.02)
    content["damping"] |= {"linear": [10.0, 1.0, 20.0, 0.1, 0.2, 0.3], "quadratic": [100.0] * 3 + [1.0] * 3}
    for coupling in content["damping"]["couplings"]:
        coupling["coefficient"] *= 1.001
    return Scene(Vehicle.model_validate(content), current=(0.1, 0.1, 0.1))


def test_memory_for_each_body():
    """Less than 1 kB and a number for each coupling, however much bodies differ; what they share is kept once."""
    scene, couplings = Scene(current=CURRENT), load_vehicle("bluerov2_heavy").damping.couplings
    assert batch_of([scene] * 63 + [other_scene()]).bytes_per_body < 1000 + 8 * len(couplings)
    assert scene.batch(64).bytes_per_body < 200
    assert scene.batch(64, precision="float32").bytes_per_body < 100


@pytest.mark.sweep
@pytest.mark.parametrize("threads", [1, 2])
@pytest.mark.parametrize(("wrench_rows", "bytes_per_body"), [("each", 8), ("all", 8 + 6 * 8)])
def test_a_step_of_a_batch_leaves_nothing_behind(threads, wrench_rows, bytes_per_body):
    """It takes one number a body for a while, to count who took the fallback; a wrench for all is written out."""
    size = 2048
    batch = Scene(current=CURRENT).batch(size, threads=threads)
    wrench = np.ones((size, 6)) if wrench_rows == "each" else np.ones(6)
    batch.step(wrench)
    growth, peak = taken_by(lambda: batch.step(wrench, 3))
    batch.close()
    assert growth < GROWTH
    assert peak < bytes_per_body * size + 16_000


def test_compiled_code_takes_no_memory_for_steps_or_bodies():
    """What it takes in a call is for the arrays handed in, however many steps and bodies."""
    scene, taken = Scene(current=CURRENT), set()
    for size in (7, 300):
        batch = scene.batch(size, threads=1)
        batch.step()
        for steps in (1, 100):
            taken.add(allocations_in(partial(batch.step, steps=steps)))
    assert len(taken) == 1
    assert taken.pop() <= 5


def bytes_in(value):
    """Bytes of the arrays in what a step returned."""
    if isinstance(value, np.ndarray):
        return value.nbytes
    parts = value.values() if isinstance(value, dict) else value
    return sum(bytes_in(part) for part in parts)


@pytest.mark.sweep
@pytest.mark.parametrize("keywords", [{}, {"copy": False}, {"threads": 2}], ids=str)
def test_a_step_of_a_vector_environment_leaves_nothing_behind(keywords):
    """It takes what it returns, twice: the last step's is dropped when the next one's is there."""
    envs = gym.make_vec("dq_marine/StationKeeping-v0", num_envs=256, **keywords)
    envs.reset(seed=0)
    actions = np.random.default_rng(0).uniform(-1.0, 1.0, envs.action_space.shape).astype(np.float32)
    result = envs.step(actions)
    growth, peak = taken_by(lambda: envs.step(actions), warm_up=320)  # beyond an episode's end
    envs.close()
    assert growth < GROWTH
    assert peak < 2 * bytes_in(result) + 32_000


def test_a_wrench_is_not_compiled_for_anew_however_it_is_given():
    """Read-only arrays too, as other libraries hand them out: compiling would hold up a running batch for long."""
    batch, wrenches = Scene(current=CURRENT).batch(7), np.ones((7, 6))
    batch.step(wrenches)
    compiled, read_only = len(batch._advance.signatures), wrenches.copy()
    read_only.flags.writeable = False
    for given_so in (np.asfortranarray(wrenches), wrenches.astype("f4"), wrenches[::-1], read_only):
        batch.step(given_so)
    assert len(batch._advance.signatures) == compiled
