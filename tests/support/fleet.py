"""Vehicles of the tests that have actuators of every kind."""

from __future__ import annotations

from dq_marine.vehicles import load_vehicle
from dq_marine.vehicles.validation import validated

PROPELLER = {"gain_forward": 0.02, "gain_reverse": 0.011, "speed_forward": 60.0, "speed_reverse": 50.0}

KINDS = {
    "direct": {},
    "lag": {"time_constant": 0.1},
    "slew": {"rate_limit": 80.0},
    "lagged slew": {"time_constant": 0.1, "rate_limit": 80.0},
}


def vehicle_with(base="bluerov2_heavy", **tables):
    """A catalogue vehicle with other thrusters, azimuths and fins."""
    content = load_vehicle(base).model_dump()
    content |= {"thrusters": (), "azimuths": (), "fins": ()} | tables
    return validated(content, "test")


def twin_screw(**propeller):
    """Two propellers on port and starboard, unequal ahead and astern."""
    sides = [("port", -0.4), ("starboard", 0.4)]
    thrusters = [
        {"name": name, "position": (-0.3, y, 0.05), "direction": (1.0, 0.0, 0.0)} | PROPELLER | propeller
        for name, y in sides
    ]
    return vehicle_with(thrusters=thrusters)


def everything():
    """A thruster in flow with torque, one with a lag, azimuths that turn all round and within limits, and fins."""
    return vehicle_with(
        thrusters=[
            {
                "position": (-0.4, 0.0, 0.1),
                "direction": (1.0, 0.1, 0.0),
                "inflow": 0.05,
                "torque_over_thrust": -0.08,
            }
            | PROPELLER
            | {"time_constant": 0.15},
            {
                "position": (0.3, 0.1, 0.0),
                "direction": (0.0, 0.0, -1.0),
                "thrust_forward": 50.0,
                "thrust_reverse": 40.0,
            }
            | {"rate_limit": 1.5, "dead_band": 0.05},
        ],
        azimuths=[
            {"position": (-0.3, 0.2, 0.1), "angle_rate_limit_deg_s": 60.0, "angle_time_constant": 0.2}
            | PROPELLER
            | {"time_constant": 0.1, "rate_limit": 90.0},
            {
                "position": (0.3, -0.2, 0.1),
                "angle_limit_deg": 40.0,
                "thrust_forward": 30.0,
                "thrust_reverse": 0.0,
            },
        ],
        fins=[
            {"coefficients": (0.0, 9.6, 0.0, 0.5, 0.0, -6.1), "limit_deg": 20.0, "time_constant": 0.2},
            {"coefficients": (-0.5, 0.0, -9.6, 0.0, -6.1, 0.0), "limit_deg": 25.0, "rate_limit_deg_s": 30.0},
        ],
    )
