"""A scene: a vehicle in water, checked once, from which a specialised stepper is made."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from dq_marine.checks import finite_array, finite_number
from dq_marine.errors import InvalidInputError
from dq_marine.kernel.current import MOVING_WATER, STILL_WATER, UniformCurrent
from dq_marine.kernel.damping import DiagonalDamping, FullDamping
from dq_marine.kernel.inertia import Inertia
from dq_marine.kernel.kick import (
    LinearKick,
    QuadraticKick,
    UndampedKick,
    diagonal_quadratic_kick,
    full_quadratic_kick,
    linear_kick,
    undamped_kick,
)
from dq_marine.kernel.midpoint_drift import midpoint_drift
from dq_marine.kernel.restoring import NetWeight, RightingMoment, net_weight, righting_moment
from dq_marine.kernel.spatial import Matrix6, Spatial, from_fossen
from dq_marine.kernel.step import Composition, StepParameters
from dq_marine.kernel.vector3 import Vector3
from dq_marine.vehicles import Vehicle, load_vehicle

if TYPE_CHECKING:
    from dq_marine.engines.one_body import OneBody

DRIFTS = {"midpoint": midpoint_drift}
"""Schemes by name."""

NEUTRAL_TOLERANCE = 1e-9
"""Net weight over weight, and righting arm over the vehicle's length, below which a term counts as absent."""


class Scene:
    """A vehicle in water of uniform steady current, with a scheme and a step.

    Everything is checked here, once. What the vehicle or the water lacks (current, damping, quadratic damping,
    net weight, righting moment, off-diagonal damping) is left out of the step: neither computed nor compiled.

    Attributes:
        vehicle: the validated vehicle.
        current_ned: velocity of the water [m/s], shape (3,).
        scheme: name of the drift.
        step: step size h [s].
        terms: names of what the step computes besides inertia and the control wrench.
    """

    def __init__(
        self,
        vehicle: Vehicle | str | os.PathLike[str] = "bluerov2_heavy",
        *,
        current: Sequence[float] | NDArray[np.float64] = (0.0, 0.0, 0.0),
        scheme: str = "midpoint",
        step: float = 0.02,
    ) -> None:
        """Check and compose the scene.

        Args:
            vehicle: a catalogue name, the path of a TOML file, or a `Vehicle`.
            current: velocity of the water in NED, shape (3,) [m/s].
            scheme: one of `DRIFTS`.
            step: step size h [s].

        Raises:
            InvalidInputError: a value is wrong, or the step is too large for the vehicle's restoring forces.
            VehicleFileError: the vehicle file is wrong.
        """
        self.vehicle = load_vehicle(vehicle)
        self.current_ned = finite_array("current", current, 3)
        if scheme not in DRIFTS:
            raise InvalidInputError(f"scheme = {scheme!r} is unknown; give one of {sorted(DRIFTS)}")
        self.scheme = scheme
        self.step = finite_number("step", step, above=0.0)
        self._check_restoring_step()
        self.composition, self.terms = self._compose()

    def __repr__(self) -> str:
        current = self.current_ned.tolist()
        terms = ", ".join(self.terms) or "nothing"
        return (
            f"Scene({self.vehicle.name!r}, current={current}, scheme={self.scheme!r}, step={self.step:g}; "
            f"computes {terms})"
        )

    def __reduce__(self) -> Any:
        """Travel as the arguments: a composition's functions are made anew where the scene arrives."""
        return _rebuild, (self.vehicle, self.current_ned.tolist(), self.scheme, self.step)

    def stepper(self) -> OneBody:
        """Return a body at rest at the world's origin, with the step compiled for this scene."""
        from dq_marine.engines.one_body import OneBody  # here: it imports Numba

        return OneBody(self.composition, self.parameters_at, self.step)

    @property
    def restoring_frequencies(self) -> NDArray[np.float64]:
        """Undamped natural angular frequencies [rad/s] about the stable upright or inverted attitude, shape (2,).

        Eigenfrequencies of roll and pitch with the other axes free to follow, from the full M.
        """
        # Attitude change dphi turns "down" by -dphi x d, hence the moment -S(arm) S(d) dphi for d along the arm.
        arm = self.vehicle.restoring_arm
        length = float(np.linalg.norm(arm))
        if length == 0.0:
            return np.zeros(2)
        direction = arm / length
        stiffness = length * (np.eye(3) - np.outer(direction, direction))
        compliance = np.linalg.inv(self.vehicle.mass_matrix)[3:, 3:]
        squares = np.sort(np.linalg.eigvals(compliance @ stiffness).real)
        return np.sqrt(np.maximum(squares[1:], 0.0))

    def parameters_at(self, step: float) -> StepParameters:
        """Return the numbers of this scene's step for a step size [s]."""
        return StepParameters(
            h=step,
            inertia=self._inertia(),
            forces=_nest([parameters for _, parameters in self._forces().values()]),
            half_kick=self._kick_parameters(0.5 * step),
            full_kick=self._kick_parameters(step),
            water=UniformCurrent(_triple(self.current_ned)) if self._has_current else (),
        )

    @property
    def _has_current(self) -> bool:
        return bool(self.current_ned.any())

    def _compose(self) -> tuple[Composition, tuple[str, ...]]:
        forces = self._forces()
        kick, damping = self._kick()
        composition = Composition(
            forces=tuple(function for function, _ in forces.values()),
            kick=kick,
            drift=DRIFTS[self.scheme],
            water=MOVING_WATER if self._has_current else STILL_WATER,
        )
        current = ("current",) if self._has_current else ()
        return composition, (*forces, *damping, *current)

    def _forces(self) -> dict[str, tuple[Any, Any]]:
        """Return the pose-dependent forces that are present: name -> (function, parameters)."""
        vehicle = self.vehicle
        forces: dict[str, tuple[Any, Any]] = {}
        excess = vehicle.weight - vehicle.buoyant_force
        if abs(excess) > NEUTRAL_TOLERANCE * vehicle.weight:
            forces["net weight"] = (net_weight, NetWeight(excess))
        arm = vehicle.restoring_arm
        scale = vehicle.weight * vehicle.dimensions.length
        if np.abs(arm).max() > NEUTRAL_TOLERANCE * scale:
            forces["righting moment"] = (righting_moment, RightingMoment(_triple(arm)))
        return forces

    def _kick(self) -> tuple[Any, tuple[str, ...]]:
        linear, quadratic = self.vehicle.linear_damping, self.vehicle.quadratic_damping
        if quadratic.any():
            if _is_diagonal(linear):
                return diagonal_quadratic_kick, ("diagonal linear and quadratic damping",)
            return full_quadratic_kick, ("full linear and quadratic damping",)
        if linear.any():
            return linear_kick, ("linear damping",)
        return undamped_kick, ()

    def _kick_parameters(self, duration: float) -> Any:
        linear, quadratic = self.vehicle.linear_damping, self.vehicle.quadratic_damping
        if quadratic.any():
            coefficients = _spatial(quadratic)
            if _is_diagonal(linear):
                damping: Any = DiagonalDamping(_spatial(np.diag(linear)), coefficients)
            else:
                damping = FullDamping(_matrix6(_angular_first(linear)), coefficients)
            return QuadraticKick(duration, damping)
        if linear.any():
            return self._linear_kick(duration)
        return UndampedKick(duration)

    def _linear_kick(self, duration: float) -> LinearKick:
        """Prepare (K2)-(K3) of `kernel.kick` for a constant D."""
        h = duration
        d = _angular_first(self.vehicle.linear_damping)
        m = _angular_first(self.vehicle.mass_matrix)
        x = d @ np.linalg.inv(m)
        one = np.eye(6)
        # mu' = mu + M dchi, and M times (M + h D + h^2/2 D M^-1 D)^-1 is (1 + h x + h^2/2 x^2)^-1.
        forcing = h * np.linalg.solve(one + h * x + 0.5 * h * h * x @ x, one + 0.5 * h * x)
        return LinearKick(_matrix6(one - forcing @ x), _matrix6(forcing))

    def _inertia(self) -> Inertia:
        m = _angular_first(self.vehicle.mass_matrix)
        inverse = np.linalg.inv(m)
        block = np.linalg.inv(m[3:, 3:])
        return Inertia(_matrix6(m), _matrix6(inverse), tuple(block.ravel().tolist()))  # type: ignore[arg-type]

    def _check_restoring_step(self) -> None:
        """The restoring moment is explicit at the node: stable for h omega < 2."""
        fastest = float(self.restoring_frequencies.max())
        if self.step * fastest >= 2.0:
            raise InvalidInputError(
                f"step = {self.step:g} s is too large for the restoring moment: h omega = "
                f"{self.step * fastest:.3g} with omega = {fastest:.3g} rad/s must stay below 2; give a step "
                f"below {2.0 / fastest:.3g} s (0.1 of it for accuracy)"
            )


def _rebuild(vehicle: Vehicle, current: list[float], scheme: str, step: float) -> Scene:
    return Scene(vehicle, current=current, scheme=scheme, step=step)


def _angular_first(m: NDArray[np.float64]) -> NDArray[np.float64]:
    """Reorder a 6x6 matrix from Fossen's order to angular first (the swap is its own inverse)."""
    order = [3, 4, 5, 0, 1, 2]
    return m[np.ix_(order, order)]


def _matrix6(m: NDArray[np.float64]) -> Matrix6:
    """Return an angular-first 6x6 array as kernel blocks."""
    blocks = (m[:3, :3], m[:3, 3:], m[3:, :3], m[3:, 3:])
    return Matrix6(*(tuple(block.ravel().tolist()) for block in blocks))  # type: ignore[arg-type]


def _spatial(a: NDArray[np.float64]) -> Spatial:
    """Return a 6-vector in Fossen's order as a kernel pair."""
    return from_fossen(tuple(a.tolist()))  # type: ignore[arg-type]


def _triple(a: NDArray[np.float64]) -> Vector3:
    """Return a 3-vector as a kernel tuple."""
    return (float(a[0]), float(a[1]), float(a[2]))


def _is_diagonal(m: NDArray[np.float64]) -> bool:
    return not (m - np.diag(np.diag(m))).any()


def _nest(items: list[Any]) -> Any:
    """Return (first, (second, (..., ())))."""
    nested: Any = ()
    for item in reversed(items):
        nested = (item, nested)
    return nested
