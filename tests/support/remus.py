"""REMUS 100 by the equations of Prestero (2001, chapter 4), term by term with Euler angles, integrated by SciPy.

Written apart from the project's: added mass is named terms here and no matrix, lift is in the same terms.
"""

import math

import numpy as np
from scipy.integrate import solve_ivp

GRAVITY = 9.80665

# Prestero (2001): his coefficients, those of drag and roll in the column adjusted to his field trials (Z_ww is not).
PRESTERO = {
    "m": 30.48, "zg": 0.0196, "Ixx": 0.177, "Iyy": 3.45, "Izz": 3.45, "net_buoyancy": 0.0,
    "Xuu": -1.62, "Xudot": -0.93, "Yvdot": -35.5, "Yrdot": 1.93, "Kpdot": -0.0704, "Nrdot": -4.88,
    "Yvv": -1310.0, "Zww": -131.0, "Yrr": 0.632, "Nvv": -3.18, "Kpp": -0.130, "Mqq": -188.0, "Nrr": -94.0,
    "Yuv": -28.6, "Zuw": -28.6, "Yur": 5.22, "Zuq": -5.22, "Nuv": -24.0, "Muw": 24.0, "Nur": -2.0, "Muq": -2.0,
    "Yuudr": 9.64, "Nuudr": -6.15, "Zuuds": -9.64, "Muuds": -6.15,
}  # fmt: skip

# The same with what Sgarioto (2006), after Fodrea, gives at 1.543 m/s, and the theoretical column of drag.
REVISED = PRESTERO | {
    "net_buoyancy": 3.34, "Xuu": -0.5 * 1030.0 * 0.42 * 0.0285,
    "Yvv": -131.0, "Mqq": -9.40, "Nrr": -9.40,
    "Yuv": -43.40546, "Zuw": -43.40546, "Yur": 2.2 / 1.543, "Zuq": -2.2 / 1.543,
    "Nuv": -4.47 / 1.543, "Muw": 4.47 / 1.543, "Nur": -4.45003, "Muq": -4.45003,
    "Yuudr": 21.37044 / 3.5, "Nuudr": -14.5896 / 3.5, "Zuuds": -21.37044, "Muuds": -14.5896,
}  # fmt: skip


def mss_propeller(shaft_speed, surge):
    """Return thrust on the hull and moment about x of MSS's propeller [N, N m], the moment by K_Q/K_T at J_max."""
    turns, diameter = shaft_speed / (2.0 * math.pi), 0.14
    advance = 0.944 * surge / (turns * diameter)
    k_t = 0.4566 + (0.1798 - 0.4566) / 0.6632 * advance
    thrust = 0.9 * 1030.0 * diameter**4 * k_t * turns**2
    return thrust, -diameter * 0.0312 / (0.9 * 0.1798) * thrust


def run(c, duration, propulsion, rudder=0.0, planes=0.0, speed=0.0):
    """Return u, v, w, p, q, r, roll, pitch, yaw, depth after a run from level motion ahead.

    Args:
        c: coefficients.
        duration: [s].
        propulsion: thrust and moment about x by the surge velocity.
        rudder: deflection [rad].
        planes: deflection [rad].
        speed: at the start [m/s].
    """
    mass = _mass_matrix(c)

    def rates(_, x):
        return np.concatenate(
            [np.linalg.solve(mass, _wrench(c, x, propulsion(x[0]), rudder, planes)), _euler(x)]
        )

    start = np.zeros(10)
    start[0] = speed
    return solve_ivp(rates, (0.0, duration), start, method="LSODA", rtol=1e-9, atol=1e-11).y[:, -1]


def _mass_matrix(c):
    m, zg = c["m"], c["zg"]
    return np.array(
        [
            [m - c["Xudot"], 0.0, 0.0, 0.0, m * zg, 0.0],
            [0.0, m - c["Yvdot"], 0.0, -m * zg, 0.0, -c["Yrdot"]],
            [0.0, 0.0, m - c["Yvdot"], 0.0, c["Yrdot"], 0.0],
            [0.0, -m * zg, 0.0, c["Ixx"] - c["Kpdot"], 0.0, 0.0],
            [m * zg, 0.0, c["Yrdot"], 0.0, c["Iyy"] - c["Nrdot"], 0.0],
            [0.0, -c["Yrdot"], 0.0, 0.0, 0.0, c["Izz"] - c["Nrdot"]],
        ]
    )


def _wrench(c, x, propulsion, rudder, planes):
    """Everything without accelerations; Z_wdot = Y_vdot, Z_qdot = -Y_rdot, M_qdot = N_rdot."""
    u, v, w, p, q, r, roll, pitch = x[:8]
    m, zg, a, e = c["m"], c["zg"], c["Yvdot"], c["Yrdot"]
    k_n = c["Kpdot"] - c["Nrdot"]
    thrust, moment = propulsion
    weight, lift = m * GRAVITY, c["net_buoyancy"]
    sin, cos = math.sin, math.cos
    surge = lift * sin(pitch) + c["Xuu"] * u * abs(u) + a * w * q - e * q * q - a * v * r - e * r * r + thrust
    sway = (
        -lift * cos(pitch) * sin(roll) + c["Yvv"] * v * abs(v) + c["Yrr"] * r * abs(r) + c["Yur"] * u * r
        - a * w * p + e * p * q + c["Yuv"] * u * v + c["Yuudr"] * u * u * rudder
    )  # fmt: skip
    heave = (
        -lift * cos(pitch) * cos(roll) + c["Zww"] * w * abs(w) - c["Yrr"] * q * abs(q) + c["Zuq"] * u * q
        + a * v * p + e * r * p + c["Zuw"] * u * w + c["Zuuds"] * u * u * planes
    )  # fmt: skip
    about_x = -zg * weight * cos(pitch) * sin(roll) + c["Kpp"] * p * abs(p) + moment
    about_y = (
        -zg * weight * sin(pitch) - c["Nvv"] * w * abs(w) + c["Mqq"] * q * abs(q) + c["Muq"] * u * q
        - e * v * p + k_n * r * p + c["Muw"] * u * w + c["Muuds"] * u * u * planes
    )  # fmt: skip
    about_z = (
        c["Nvv"] * v * abs(v) + c["Nrr"] * r * abs(r) + c["Nur"] * u * r - e * w * p - k_n * p * q
        + c["Nuv"] * u * v + c["Nuudr"] * u * u * rudder
    )  # fmt: skip
    return np.array(
        [
            surge - m * (w * q - v * r + zg * p * r),
            sway - m * (u * r - w * p + zg * q * r),
            heave - m * (v * p - u * q - zg * (p * p + q * q)),
            about_x - (c["Izz"] - c["Iyy"]) * q * r + m * zg * (u * r - w * p),
            about_y - (c["Ixx"] - c["Izz"]) * r * p - m * zg * (w * q - v * r),
            about_z - (c["Iyy"] - c["Ixx"]) * p * q,
        ]
    )


def _euler(x):
    p, q, r, roll, pitch = x[3:8]
    across = q * math.sin(roll) + r * math.cos(roll)
    return np.array(
        [
            p + across * math.tan(pitch),
            q * math.cos(roll) - r * math.sin(roll),
            across / math.cos(pitch),
            -x[0] * math.sin(pitch) + math.cos(pitch) * (x[1] * math.sin(roll) + x[2] * math.cos(roll)),
        ]
    )
