"""Forces that cases have besides weight, buoyancy and damping: an oscillating thrust, and a ship's waterplane."""

from __future__ import annotations

from typing import NamedTuple

from dq_marine.algebra.dual_quaternion import DualQuaternion, pose_position
from dq_marine.algebra.elementary import sine_and_cosine
from dq_marine.algebra.quaternion import world_down_in_body
from dq_marine.algebra.spatial import Spatial, spatial_add_scaled, spatial_scale
from dq_marine.algebra.vector3 import scale


class Oscillation(NamedTuple):
    """A body wrench that oscillates on all axes, each with a phase of its own.

    Attributes:
        frequency: [rad/s].
        sine: what goes with sin(frequency t) [N m, N].
        cosine: what goes with cos(frequency t).
    """

    frequency: float
    sine: Spatial
    cosine: Spatial


def oscillation(term: Oscillation, time: float) -> Spatial:
    """Return sine sin(w t) + cosine cos(w t)."""
    sine, cosine = sine_and_cosine(term.frequency * time)
    return spatial_add_scaled(spatial_scale(sine, term.sine), cosine, term.cosine)


class Waterplane(NamedTuple):
    """Restoring of a ship that is symmetric to port and starboard, about an origin in the waterline.

    Attributes:
        heave: Z_z, rho g times the waterplane's area [N/m].
        roll: K_phi, rho g times the volume times the transverse GM [N m].
        pitch: M_theta, the same with the longitudinal GM [N m].
        heave_pitch: Z_theta = M_z [N].
    """

    heave: float
    roll: float
    pitch: float
    heave_pitch: float


def waterplane(term: Waterplane, pose: DualQuaternion, time: float) -> Spatial:
    """Return the wrench that is -G eta for small z, phi and theta (Fossen 2021, sec. 4.2), and conservative for all.

    With d the body-frame direction of down, d = (-theta, phi, 1) to first order, and z the depth of the origin, the
    potential is

        V = (1/2) Z_z z^2 - Z_theta z d_x + (1/2) M_theta d_x^2 + (1/2) K_phi d_y^2,

    hence the force -dV/dz along d and the moment d x dV/dd.
    """
    d = world_down_in_body(pose.real)
    z = pose_position(pose)[2]
    x, y = term.pitch * d[0] - term.heave_pitch * z, term.roll * d[1]
    down = term.heave_pitch * d[0] - term.heave * z
    return Spatial((-d[2] * y, d[2] * x, d[0] * y - d[1] * x), scale(down, d))


def waterplane_potential(term: Waterplane, pose: DualQuaternion) -> float:
    """Return V of `waterplane` [J]."""
    d = world_down_in_body(pose.real)
    z = pose_position(pose)[2]
    heaving = 0.5 * term.heave * z * z - term.heave_pitch * z * d[0]
    return heaving + 0.5 * (term.pitch * d[0] * d[0] + term.roll * d[1] * d[1])
