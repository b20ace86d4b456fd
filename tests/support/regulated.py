"""Vehicles of the catalogue with their regulators, as tracking by LQR has them."""

from __future__ import annotations

import numpy as np

from dq_marine.agents.controllers.deviation import LinearModel, deviation_model, sampled
from dq_marine.agents.controllers.hydrodynamic_model import HydrodynamicModel
from dq_marine.agents.controllers.lqr import Regulator, Weights, bryson_weights, regulator
from dq_marine.agents.preset_files import read_settings
from dq_marine.agents.settings import TrajectorySettings
from dq_marine.vehicles import load_vehicle


def regulated(name: str, speed: float = 0.4) -> tuple[LinearModel, Weights, Regulator]:
    """Return the sampled model about a straight way at a speed, its weights and its regulator."""
    vehicle = load_vehicle(name)
    straight = np.array([speed, 0.0, 0.0, 0.0, 0.0, 0.0])
    model = sampled(deviation_model(HydrodynamicModel(vehicle), straight), 0.1)
    weights = bryson_weights(read_settings("trajectory", TrajectorySettings), vehicle)
    return model, weights, regulator(model, weights)
