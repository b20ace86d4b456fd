"""One seeded program, small enough to be compiled anew, of whose every bit it prints a hash.

`python -m support.bits PART...` prints JSON: of each part, a hash of what was computed alone and of what was computed
in rows or lanes. The vehicles' matrices are diagonal: their inverses have no sums, so that the numbers which flights
start from are the same whichever BLAS inverts them.
"""

from __future__ import annotations

import hashlib
import json
import sys
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dq_marine.backend.packing import pack
from dq_marine.simulation.batch import Batch
from dq_marine.simulation.one_body import OneBody
from dq_marine.simulation.scene import Scene, batch_of
from dq_marine.task.sensors.build import AHRS, DVL
from dq_marine.vehicles import Vehicle, load_vehicle
from support.environments import StationKeepingEnv, StationKeepingVectorEnv

Array = NDArray[np.float64]

BODIES = 11
"""More than a block of lanes holds, and not a multiple of it."""

SENSORS = (DVL(noise=0.02, scale=0.01), AHRS(noise=0.01, walk=0.01, dropout=0.2))


def different_vehicle(rng: np.random.Generator) -> Vehicle:
    """A vehicle with numbers of its own, all matrices diagonal."""
    content = load_vehicle("bluerov2_heavy").model_dump()
    added_mass, linear = (np.diag(matrix) for matrix in (content["added_mass"], content["damping"]["linear"]))
    content["added_mass"] = np.diag(added_mass * rng.uniform(0.9, 1.1, 6)).tolist()
    content["damping"]["linear"] = np.diag(linear + rng.uniform(0.1, 1.0, 6)).tolist()
    return Vehicle.model_validate(content)


def scenes_and_starts() -> tuple[list[Scene], tuple[Array, Array, Array]]:
    """Scenes of order 4 that differ, and a position, a quaternion of nearly unit length and a velocity for each."""
    rng = np.random.default_rng(10)
    scenes = [
        Scene(different_vehicle(rng), current=rng.normal(scale=0.2, size=3), order=4) for _ in range(BODIES)
    ]
    lengths = 1.0 + 1e-7 * rng.normal(size=(BODIES, 1))
    return scenes, (
        rng.normal(size=(BODIES, 3)),
        unit_quaternions(rng) * lengths,
        rng.normal(size=(BODIES, 6)),
    )


def unit_quaternions(rng: np.random.Generator) -> Array:
    """Attitudes, summed up as no processor can do otherwise."""
    q = rng.normal(size=(BODIES, 4))
    squares = (q * q).T
    return q / np.sqrt(squares[0] + squares[1] + squares[2] + squares[3])[:, None]


def placed() -> tuple[list[OneBody], Batch]:
    """Bodies at their starts, alone and in a batch; nothing is compiled for that."""
    scenes, starts = scenes_and_starts()
    batch, alone = batch_of(scenes, threads=1), [scene.stepper() for scene in scenes]
    batch.reset(*starts)
    for body, row in zip(alone, zip(*starts, strict=True), strict=True):
        body.reset(*row)
    return alone, batch


def starts() -> tuple[bytes, bytes]:
    """Bodies where they are placed, and the numbers of their steps."""
    alone, batch = placed()
    numbers = b"".join(pack(body.parameters).tobytes() for body in alone)
    states = np.array([body.get_state() for body in alone])
    return numbers + states.tobytes(), numbers + batch.get_state().tobytes()


def flights() -> tuple[bytes, bytes]:
    """Bodies under wrenches, by a method of order 4."""
    alone, batch = placed()
    wrenches = np.random.default_rng(12).normal(scale=20.0, size=(BODIES, 6))
    batch.step(wrenches, 40)
    for body, wrench in zip(alone, wrenches, strict=True):
        body.step(wrench, 40)
    return np.array([body.get_state() for body in alone]).tobytes(), batch.get_state().tobytes()


def episodes() -> tuple[bytes, bytes]:
    """Environments with sensors, whose starts are drawn and then chosen, and a vector environment."""
    rng = np.random.default_rng(11)
    chosen = unit_quaternions(rng)
    singles = [StationKeepingEnv(sensors=SENSORS) for _ in range(BODIES)]
    envs = StationKeepingVectorEnv(BODIES, sensors=SENSORS, threads=1)
    alone: list[Any] = []
    together: list[Any] = []
    for options in ({}, {"quaternion": chosen, "goal_quaternion": chosen[::-1].copy()}):
        for i, env in enumerate(singles):
            own = {name: rows[i] for name, rows in options.items()}
            alone.append(env.reset(seed=20 + i, options=own)[0])
        together.append(envs.reset(seed=20, options=options)[0])
        for _ in range(10):
            actions = rng.uniform(-1.5, 1.5, (BODIES, 6)).astype(np.float32)
            steps = [env.step(action) for env, action in zip(singles, actions, strict=True)]
            alone += [[step[i] for step in steps] for i in range(3)]
            together += envs.step(actions)[:3]
    alone.append([env.get_state()["state"] for env in singles])
    together.append([state["state"] for state in envs.call("get_state")])
    return bytes_of(alone), bytes_of(together)


def bytes_of(parts: list[Any]) -> bytes:
    """All bits of arrays, one after the other."""
    return b"".join(np.asarray(part).tobytes() for part in parts)


PARTS = {"starts": starts, "flights": flights, "episodes": episodes}


if __name__ == "__main__":
    found = {name: [hashlib.sha256(bits).hexdigest()[:16] for bits in PARTS[name]()] for name in sys.argv[1:]}
    print(json.dumps(found))
