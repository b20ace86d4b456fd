"""First-order wave force by transfer functions: for hulls whose answer to each wave is known beforehand.

A component with phase theta at the body origin (see `physics.waves.formulas.kinematics`), which goes into the
direction beta relative to the heading (0 a following sea, pi/2 from port, pi a head sea), makes the wrench

    Re( a F(omega, beta) e^{i theta} ),   F = sum_n F_n^c cos(n beta) + F_n^s sin(n beta)

in the body frame. The series in the heading keeps the force smooth while the vessel turns, and costs no look-up, which
bodies in lanes would make apart.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from dq_marine.algebra.dual_quaternion import DualQuaternion, pose_position
from dq_marine.algebra.elementary import sine_and_cosine
from dq_marine.algebra.quaternion import Quaternion
from dq_marine.algebra.selection import smallest_normal, spread
from dq_marine.algebra.spatial import Spatial
from dq_marine.algebra.table import Table
from dq_marine.algebra.vector3 import Vector3
from dq_marine.physics.waves.formulas.kinematics import WaveField, wave_phase

NUMBERS_OF_A_HARMONIC = 24
"""Of one component: (real and imaginary part of [force; moment] by cos, and by sin), 2 x 2 x 6."""


class WaveTransfer(NamedTuple):
    """Parameters of the force.

    Attributes:
        sea: the components.
        harmonics: of each component: short waves need more.
        transfer: a F_n: for each component, for n = 0, 1, ..., 24 numbers: of the cosine part the real parts of X, Y,
            Z, K, M, N and their imaginary parts, then those of the sine part [N, N m].
    """

    sea: WaveField
    harmonics: Table
    transfer: Table


def heading_of(attitude: Quaternion) -> tuple[float, float]:
    """Return cosine and sine of the angle from north to the body's x axis as seen from above."""
    w, x, y, z = attitude
    north, east = 1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z)
    length = math.sqrt(north * north + east * east + smallest_normal(north))
    return north / length, east / length


def harmonic_part(
    table: Table, first: int, of_cosine: tuple[float, float], of_sine: tuple[float, float]
) -> Vector3:
    """Return three axes of one harmonic's wrench, the first of which stands at `first`.

    The pairs are (cos theta, sin theta), times cos(n beta) and times sin(n beta).
    """
    return (
        harmonic_axis(table, first, of_cosine, of_sine),
        harmonic_axis(table, first + 1, of_cosine, of_sine),
        harmonic_axis(table, first + 2, of_cosine, of_sine),
    )


def harmonic_axis(
    table: Table, place: int, of_cosine: tuple[float, float], of_sine: tuple[float, float]
) -> float:
    """Return one axis of `harmonic_part`: Re(F e^{i theta}) = Re F cos theta - Im F sin theta, twice."""
    by_cosine = table[place] * of_cosine[0] - table[place + 6] * of_cosine[1]
    return by_cosine + (table[place + 12] * of_sine[0] - table[place + 18] * of_sine[1])


def transferred_waves(parameters: WaveTransfer, pose: DualQuaternion, time: float) -> Spatial:
    """Return the wrench of all components."""
    sea, transfer, place = parameters.sea, parameters.transfer, pose_position(pose)
    ahead, aside = heading_of(pose.real)
    zero = spread(0.0, ahead)
    x, y, z = zero, zero, zero
    k, m, n = zero, zero, zero
    first = 0
    for j in range(len(sea.amplitude)):
        sine, cosine = sine_and_cosine(wave_phase(sea, j, place[0], place[1], time))
        north, east = sea.north[j] / sea.wave_number[j], sea.east[j] / sea.wave_number[j]
        turn_cosine, turn_sine = north * ahead + east * aside, east * ahead - north * aside
        by_cosine, by_sine = zero + 1.0, zero
        for _ in range(int(parameters.harmonics[j])):
            of_cosine = (by_cosine * cosine, by_cosine * sine)
            of_sine = (by_sine * cosine, by_sine * sine)
            force = harmonic_part(transfer, first, of_cosine, of_sine)
            moment = harmonic_part(transfer, first + 3, of_cosine, of_sine)
            x, y, z = x + force[0], y + force[1], z + force[2]
            k, m, n = k + moment[0], m + moment[1], n + moment[2]
            by_cosine, by_sine = (
                by_cosine * turn_cosine - by_sine * turn_sine,
                by_sine * turn_cosine + by_cosine * turn_sine,
            )
            first += NUMBERS_OF_A_HARMONIC
    return Spatial((k, m, n), (x, y, z))
