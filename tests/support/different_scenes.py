"""Scenes whose vehicles and currents differ in every number that can."""

import functools

import numpy as np

from dq_marine.simulation.scene import Scene
from dq_marine.vehicles import load_vehicle
from dq_marine.vehicles.model import Vehicle


@functools.cache
def different_scenes():
    """Scenes whose vehicles and currents differ in every number that can."""
    return [Scene(different_vehicle(seed), current=(0.2, 0.01 * seed, -0.1)) for seed in range(64)]


def different_vehicle(seed):
    rng, content = np.random.default_rng(seed), load_vehicle("bluerov2_heavy").model_dump()
    factor = rng.uniform(0.9, 1.1)
    content["rigid_body"]["mass"] *= factor
    content["buoyancy"]["volume"] *= factor * rng.uniform(0.999, 1.001)
    content["buoyancy"]["center"] = (0.02 * rng.normal(size=3)).tolist()
    content["added_mass"] = (np.diag(content["added_mass"]) * rng.uniform(0.9, 1.1, 6)).tolist()
    linear, quadratic = np.diag(content["damping"]["linear"]), np.array(content["damping"]["quadratic"])
    content["damping"]["linear"] = (linear + rng.uniform(0.1, 1.0, 6)).tolist()
    content["damping"]["quadratic"] = (quadratic * rng.uniform(0.9, 1.1, 6)).tolist()
    return Vehicle.model_validate(content)
