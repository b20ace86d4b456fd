"""Simulated logs: a vehicle under random wrenches, seen with the noise of a DVL, an AHRS and a depth meter."""

from __future__ import annotations

import csv
import functools
from pathlib import Path

import numpy as np

from dq_marine import Scene, load_vehicle
from dq_marine.algebra.attitude import attitude_angles
from dq_marine.identification.parameters import parameters_of, vehicle_with
from dq_marine.identification.starts import product
from dq_marine.vehicles import Vehicle

STEP = 0.05
"""Of the truth and of the fits: what is tested is the estimate, not the integrator."""

PERIOD = 0.1
GROUPS = ("added_mass", "linear", "quadratic")
NOISE = {"depth_m": 0.02, "deg": 0.3, "m_s": 0.01, "rad_s": 0.005}
COLUMNS = (
    *("time_s", "depth_m", "roll_deg", "pitch_deg", "heading_deg"),
    *("u_m_s", "v_m_s", "w_m_s", "p_rad_s", "q_rad_s", "r_rad_s"),
    *("X_N", "Y_N", "Z_N", "K_N_m", "M_N_m", "N_N_m"),
)
LARGEST = np.array([40.0, 40.0, 30.0, 2.0, 2.0, 5.0])


def changed(vehicle: Vehicle, groups: tuple[str, ...], seed: int, spread: float = 0.4) -> Vehicle:
    """Return the vehicle with each of its parameters changed by up to tens of per cent."""
    parameters = parameters_of(vehicle, groups)
    return vehicle_with(
        vehicle, parameters, np.random.default_rng(seed).uniform(-spread, spread, len(parameters))
    )


@functools.cache
def rov_log(
    seed: int,
    seconds: float,
    axes: tuple[int, ...] = tuple(range(6)),
    current: tuple[float, float, float] = (0.0, 0.0, 0.0),
) -> tuple[tuple[float, ...], ...]:
    """Return the rows of a changed BlueROV2 Heavy that is driven in some axes, another wrench every two seconds."""
    rng = np.random.default_rng(seed)
    vehicle = changed(load_vehicle("bluerov2_heavy"), GROUPS, seed)
    body = Scene(vehicle, step=STEP, current=current).stepper()
    wrench, driven = np.zeros(6), np.isin(np.arange(6), axes)
    rows = []
    for k in range(round(seconds / PERIOD) + 1):
        if k % 20 == 0:
            wrench = np.where(driven & (rng.random(6) < 0.6), rng.uniform(-1.0, 1.0, 6) * LARGEST, 0.0)
        turn = np.concatenate([[1.0], 0.5 * rng.normal(0.0, np.radians(NOISE["deg"]), 3)])
        seen = product(body.quaternion_body_to_ned, turn / np.linalg.norm(turn))
        angles = np.degrees(attitude_angles(seen.tolist()))
        noise = np.repeat([NOISE["m_s"], NOISE["rad_s"]], 3)
        velocity = body.velocity_body + noise * rng.normal(size=6)
        depth = body.position_ned[2] + rng.normal(0.0, NOISE["depth_m"])
        rows.append((k * PERIOD, depth, *angles, *velocity, *wrench))
        body.step(wrench, round(PERIOD / STEP))
    return tuple(rows)


def written(path: Path, rows, columns=COLUMNS) -> Path:
    """Write rows as a log."""
    with path.open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(columns)
        writer.writerows(rows)
    return path
