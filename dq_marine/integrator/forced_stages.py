"""Where a body is at the stages of a step with forces, and how fast that changes there.

With c = h mu, W = M^-1 and the forces F at the stages (docs/theory.md, eqs. G7 and G8)

    K_i = ad*_(W y_i) y_i + h^2 F(p_i, chi_i, t_i)                                                   (G7)
    q_i = q + sum_j A_ij q_j (0, omega_j)/2,   x_i = x + sum_j A_ij q_j v_j q_j*,   [omega; v] = W y (G8)
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from dq_marine.algebra.dual_quaternion import pose_from_parts
from dq_marine.algebra.frames import momentum_bracket
from dq_marine.algebra.quaternion import (
    Quaternion,
    quaternion_add,
    quaternion_dot,
    quaternion_scale,
    rotate,
)
from dq_marine.algebra.spatial import Spatial, spatial_add, spatial_add_scaled, spatial_scale
from dq_marine.algebra.stages import each_stage, stage_product
from dq_marine.algebra.vector3 import Vector3, add, add_scaled, scale
from dq_marine.integrator.collocation import Collocation
from dq_marine.integrator.gauss_stages import weighted_square
from dq_marine.integrator.increment import turned
from dq_marine.integrator.inertia import twist_from_momentum
from dq_marine.integrator.step import Composition, StepParameters


class Place(NamedTuple):
    """What is integrated: c = h mu, the attitude, and the way since the step's start in world axes [m]."""

    momentum: Spatial
    attitude: Quaternion
    way: Vector3


class ForcedStage(NamedTuple):
    """One evaluation of (G7) and of the rates in (G8): these, h^2 F, h times the twist, and the attitude there."""

    rate: Place
    wrench: Spatial
    twist: Spatial
    attitude: Quaternion


class Surroundings(NamedTuple):
    """What the rates depend on besides where the body is.

    Attributes:
        parameters: of the step.
        length_squared: see `gauss_stages.squared_length`.
        size: the square of the momentum that changes are compared with.
        h: step size [s].
        position: at the step's start [m].
        wrench: constant, body frame.
        began: time of the step's start [s].
        elapsed: from then to the stage [s].
    """

    parameters: StepParameters
    length_squared: float
    size: float
    h: float
    position: Vector3
    wrench: Spatial
    began: float
    elapsed: float


def moved_place(place: Place, s: float, rate: Place) -> Place:
    """Return place + s rate."""
    return Place(
        spatial_add_scaled(place.momentum, s, rate.momentum),
        quaternion_add(place.attitude, quaternion_scale(s, rate.attitude)),
        add_scaled(place.way, s, rate.way),
    )


def place_extent(around: Surroundings, rate: Place) -> float:
    """Return the square of the size of a rate; ways follow from the rest, or show in the forces."""
    turning = around.size * quaternion_dot(rate.attitude, rate.attitude)
    return weighted_square(around.length_squared, rate.momentum) + turning


def follow(start: Place, change: Place) -> Place:
    """Return start + change."""
    return moved_place(start, 1.0, change)


def turning(attitude: Quaternion, twist: Spatial) -> Quaternion:
    """Return the rate of an attitude (G8)."""
    return turned(attitude, scale(0.5, twist.angular))


def travelling(attitude: Quaternion, twist: Spatial) -> Vector3:
    """Return the rate of the way (G8)."""
    return rotate(attitude, twist.linear)


def make_momentum_rate(
    composition: Composition,
) -> Callable[[Surroundings, Place, Spatial, Quaternion, Vector3], ForcedStage]:
    """Return (surroundings, place, twist, rates of attitude and way) -> these, with the rate of the momentum (G7)."""
    forces_at, carry = composition.stage_forces, composition.water.at_stages.carry

    def momentum_rate(
        around: Surroundings, place: Place, twist: Spatial, attitude_rate: Quaternion, way_rate: Vector3
    ) -> ForcedStage:
        parameters, time = around.parameters, around.began + around.elapsed
        pose = pose_from_parts(place.attitude, add(around.position, place.way))
        pose = carry(parameters.water, around.began, around.elapsed, pose)
        acting = forces_at(parameters, pose, spatial_scale(1.0 / around.h, twist), time, around.wrench)
        wrench = spatial_scale(around.h * around.h, acting)
        rate = spatial_add(momentum_bracket(twist, place.momentum), wrench)  # (G7)
        return ForcedStage(Place(rate, attitude_rate, way_rate), wrench, twist, place.attitude)

    return momentum_rate


def make_evaluate(composition: Composition) -> Callable[[Surroundings, Place], ForcedStage]:
    """Return (surroundings, place) -> one evaluation of (G7) and of the rates in (G8)."""
    momentum_rate = make_momentum_rate(composition)

    def evaluate(around: Surroundings, place: Place) -> ForcedStage:
        twist = twist_from_momentum(around.parameters.inertia, place.momentum)
        attitude_rate, way_rate = turning(place.attitude, twist), travelling(place.attitude, twist)
        return momentum_rate(around, place, twist, attitude_rate, way_rate)

    return evaluate


def make_forced_sweep(
    composition: Composition, method: Collocation
) -> Callable[[Surroundings, Place, ForcedStage], Any]:
    """Return (surroundings, start, evaluation at all stages) -> the next sweep's.

    The momentum comes first, then the attitude by the new twist, then the way by both, and then the forces there: a
    force that pulls back is felt in one sweep, not in three.
    """
    momentum_rate = make_momentum_rate(composition)
    weights, matrix = method.weights, method.matrix

    def sweep(around: Surroundings, start: Place, now: ForcedStage) -> Any:
        inertia = around.parameters.inertia
        gained = stage_product(matrix, now.rate.momentum)
        momentum = each_stage(weights, spatial_add, (start.momentum, gained))  # (G1)
        twist = each_stage(weights, twist_from_momentum, (inertia, momentum))
        attitude_rate = each_stage(weights, turning, (now.attitude, twist))
        turn = stage_product(matrix, attitude_rate)
        attitude = each_stage(weights, quaternion_add, (start.attitude, turn))  # (G8)
        way_rate = each_stage(weights, travelling, (attitude, twist))
        way = each_stage(weights, add, (start.way, stage_product(matrix, way_rate)))
        place = Place(momentum, attitude, way)
        return each_stage(weights, momentum_rate, (around, place, twist, attitude_rate, way_rate))

    return sweep


def multiplied(a: float, b: float) -> float:
    """Return a b."""
    return a * b
