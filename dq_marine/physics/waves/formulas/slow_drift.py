"""Slow drift: the second-order force of a sea, mean and slowly varying, by Newman's approximation.

A regular wave of amplitude a and frequency omega pushes with D(omega) a^2. In a sea, two components push with the
difference of their frequencies, by about what each does alone (Newman 1974): with theta_j the components' phases,

    F = sum_jk a_j a_k D_jk cos(theta_j - theta_k),   D_jk = sign(D) sqrt(|D_j D_k|), 0 where the signs differ

which is Re(S conj(C)) with S = sum_j a_j sign(D_j) sqrt|D_j| e^{i theta_j} and C the same without the sign: the work of
one sum, not of a double one. Its mean is sum_j a_j^2 D_j.
"""

from __future__ import annotations

from typing import NamedTuple

from dq_marine.algebra.dual_quaternion import DualQuaternion, pose_position
from dq_marine.algebra.elementary import sine_and_cosine
from dq_marine.algebra.selection import spread
from dq_marine.algebra.spatial import Spatial
from dq_marine.algebra.table import Table
from dq_marine.physics.waves.formulas.kinematics import WaveField, wave_phase
from dq_marine.physics.waves.formulas.transfer import heading_of


class DriftRoots(NamedTuple):
    """Of one axis, for each component: a sqrt|D| [N^(1/2)], without the sign of D and with it."""

    plain: Table
    signed: Table


class WaveDrift(NamedTuple):
    """Parameters of the force.

    Attributes:
        sea: the components.
        north: of the waves' mean direction, a unit vector.
        east: the same.
        surge: in waves along the vessel.
        sway: in waves across it.
        yaw: in waves at pi/4.
    """

    sea: WaveField
    north: float
    east: float
    surge: DriftRoots
    sway: DriftRoots
    yaw: DriftRoots


class Sums(NamedTuple):
    """Of one axis: C and S, real and imaginary part."""

    plain_real: float
    plain_imaginary: float
    signed_real: float
    signed_imaginary: float


def sums_with(sums: Sums, roots: DriftRoots, j: int, sine: float, cosine: float) -> Sums:
    """Return the sums with component j."""
    plain, signed = roots.plain[j], roots.signed[j]
    return Sums(
        sums.plain_real + plain * cosine,
        sums.plain_imaginary + plain * sine,
        sums.signed_real + signed * cosine,
        sums.signed_imaginary + signed * sine,
    )


def push_of(sums: Sums) -> float:
    """Return Re(S conj(C))."""
    return sums.signed_real * sums.plain_real + sums.signed_imaginary * sums.plain_imaginary


def wave_drift(parameters: WaveDrift, pose: DualQuaternion, time: float) -> Spatial:
    """Return the wrench: surge by cos|cos|, sway by sin|sin| and yaw by sin 2 of the waves' relative direction."""
    sea, place = parameters.sea, pose_position(pose)
    ahead, aside = heading_of(pose.real)
    along = parameters.north * ahead + parameters.east * aside
    across = parameters.east * ahead - parameters.north * aside
    nothing = spread(Sums(0.0, 0.0, 0.0, 0.0), ahead)
    surge, sway, yaw = nothing, nothing, nothing
    for j in range(len(sea.amplitude)):
        sine, cosine = sine_and_cosine(wave_phase(sea, j, place[0], place[1], time))
        surge = sums_with(surge, parameters.surge, j, sine, cosine)
        sway = sums_with(sway, parameters.sway, j, sine, cosine)
        yaw = sums_with(yaw, parameters.yaw, j, sine, cosine)
    zero = spread(0.0, ahead)
    force = (along * abs(along) * push_of(surge), across * abs(across) * push_of(sway), zero)
    return Spatial((zero, zero, 2.0 * along * across * push_of(yaw)), force)
