"""Quadratic drag on the velocity through the water that waves move.

A vehicle's damping knows the velocity through the water as a current carries it. This force makes up for the rest: with
the vehicle's velocity v and the waves' u at its centre, in the body frame, each axis has

    q (|v| v - |v - u| (v - u))

which replaces the drag -q |v| v by that of the relative velocity (Morison's equation with relative velocity; Faltinsen
1990, sec. 7.1).
"""

from __future__ import annotations

from typing import NamedTuple

from dq_marine.algebra.dual_quaternion import DualQuaternion, pose_position
from dq_marine.algebra.quaternion import rotate, rotate_inverse
from dq_marine.algebra.selection import spread
from dq_marine.algebra.spatial import Spatial
from dq_marine.algebra.vector3 import Vector3, absolute, add, multiply_elementwise, subtract
from dq_marine.integrator.forces import VelocityForce
from dq_marine.physics.waves.formulas.kinematics import Orbit, WaveField, bottom_orbit, deep_orbit


class WaveDrag(NamedTuple):
    """Parameters of the force: the sea, the hull's centre [m], and q of surge, sway and heave [N s^2/m^2]."""

    sea: WaveField
    centre: Vector3
    quadratic: Vector3


def drag_of(quadratic: Vector3, velocity: Vector3) -> Vector3:
    """Return q |v| v of each axis."""
    return multiply_elementwise(quadratic, multiply_elementwise(absolute(velocity), velocity))


def make_wave_drag(orbit: Orbit) -> VelocityForce:
    """Return the force in water that moves in such orbits."""

    def wave_drag(parameters: WaveDrag, pose: DualQuaternion, twist: Spatial, time: float) -> Spatial:
        place = add(pose_position(pose), rotate(pose.real, parameters.centre))
        water = rotate_inverse(pose.real, orbit(parameters.sea, place, time).velocity)
        through = drag_of(parameters.quadratic, subtract(twist.linear, water))
        force = subtract(drag_of(parameters.quadratic, twist.linear), through)
        return Spatial(spread((0.0, 0.0, 0.0), pose.real[0]), force)

    return wave_drag


wave_drag_in_deep_water = make_wave_drag(deep_orbit)
wave_drag_over_bottom = make_wave_drag(bottom_orbit)
