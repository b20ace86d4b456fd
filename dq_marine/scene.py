"""A scene: a vehicle in water, checked once, from which a specialised stepper is made."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from dq_marine.checks import finite_array, finite_number
from dq_marine.errors import InvalidInputError
from dq_marine.kernel.composed import STAGES, ComposedTiming, make_composed
from dq_marine.kernel.current import MOVING_WATER, STILL_WATER, UniformCurrent
from dq_marine.kernel.midpoint_drift import midpoint_drift, midpoint_rescue
from dq_marine.kernel.paper_drift import paper_drift, paper_rescue
from dq_marine.kernel.step import Composition, StepParameters
from dq_marine.kernel.strang import make_strang
from dq_marine.terms import (
    DampingTerm,
    ForceTerm,
    inertia_term,
    nested_parameters,
    restoring_terms,
    strang_timing,
    vector3,
)
from dq_marine.vehicles import Vehicle, load_vehicle

if TYPE_CHECKING:
    from dq_marine.engines.one_body import OneBody

DRIFTS = {"midpoint": (midpoint_drift, midpoint_rescue), "paper": (paper_drift, paper_rescue)}
"""Schemes by name: the drift, and its rescue."""

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
        order: of the method.
        terms: names of what the step computes besides inertia and the control wrench.
    """

    def __init__(
        self,
        vehicle: Vehicle | str | os.PathLike[str] = "bluerov2_heavy",
        *,
        current: Sequence[float] | NDArray[np.float64] = (0.0, 0.0, 0.0),
        scheme: str = "midpoint",
        step: float = 0.02,
        order: int = 2,
    ) -> None:
        """Check and compose the scene.

        Args:
            vehicle: a catalogue name, the path of a TOML file, or a `Vehicle`.
            current: velocity of the water in NED, shape (3,) [m/s].
            scheme: one of `DRIFTS`.
            step: step size h [s]; negative runs time backwards, in an undamped scene.
            order: of the method, 2, or 4, 6 or 8 in an undamped scene.

        Raises:
            InvalidInputError: a value is wrong, or the step is too large for the vehicle's restoring forces.
            VehicleFileError: the vehicle file is wrong.
        """
        self.vehicle = load_vehicle(vehicle)
        self.current_ned = finite_array("current", current, 3)
        if scheme not in DRIFTS:
            raise InvalidInputError(f"scheme = {scheme!r} is unknown; give one of {sorted(DRIFTS)}")
        self.scheme = scheme
        self.step = finite_number("step", step)
        self.order = order
        self._check_restoring_step()
        self._restoring = self._restoring_terms()
        self._damping = DampingTerm(
            self.vehicle.linear_damping, self.vehicle.quadratic_damping, self.vehicle.mass_matrix
        )
        self._check_method()
        self._inertia = inertia_term(self.vehicle.mass_matrix)
        names = [*(term.name for term in self._restoring), self._damping.name]
        self.terms = tuple(filter(None, [*names, "current" if self._has_current else ""]))
        drift, rescue = DRIFTS[scheme]
        self.composition = Composition(
            method=make_strang if self.order == 2 else make_composed,
            forces=tuple(term.function for term in self._restoring),
            kick=self._damping.kick,
            drift=drift,
            rescue=rescue,
            water=MOVING_WATER if self._has_current else STILL_WATER,
        )

    def __repr__(self) -> str:
        current = self.current_ned.tolist()
        terms = ", ".join(self.terms) or "nothing"
        return (
            f"Scene({self.vehicle.name!r}, current={current}, scheme={self.scheme!r}, step={self.step:g}; "
            f"computes {terms})"
        )

    def __reduce__(self) -> Any:
        """Travel as the arguments: a composition's functions are made anew where the scene arrives."""
        return _rebuild, (
            self.vehicle,
            self.current_ned.tolist(),
            self.scheme,
            self.step,
            self.order,
        )

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
            inertia=self._inertia,
            forces=nested_parameters(self._restoring),
            water=UniformCurrent(vector3(self.current_ned)) if self._has_current else (),
            timing=self._timing(step),
        )

    def _timing(self, step: float) -> Any:
        """Return what the method needs to know of a step size."""
        if self.order == 2:
            return strang_timing(step, self._damping)
        return ComposedTiming(tuple(step * stage for stage in STAGES[self.order]))

    @property
    def _has_current(self) -> bool:
        return bool(self.current_ned.any())

    def _restoring_terms(self) -> tuple[ForceTerm, ...]:
        """Return the restoring forces, without those that are zero but for round-off."""
        vehicle = self.vehicle
        excess, arm = vehicle.weight - vehicle.buoyant_force, vehicle.restoring_arm
        if abs(excess) <= NEUTRAL_TOLERANCE * vehicle.weight:
            excess = 0.0
        if np.abs(arm).max() <= NEUTRAL_TOLERANCE * vehicle.weight * vehicle.dimensions.length:
            arm = np.zeros(3)
        return restoring_terms(excess, arm)

    def _check_method(self) -> None:
        """Negative steps, and the negative stages of high orders, undo damping unstably."""
        if self.step == 0.0:
            raise InvalidInputError("step = 0 s; give a positive step, or a negative one to run time backwards")
        if self.order not in (2, *STAGES):
            raise InvalidInputError(f"order = {self.order!r}; give one of {[2, *STAGES]}")
        if not self._damping.name:
            return
        if self.step < 0.0:
            raise InvalidInputError(
                f"step = {self.step:g} s, but the vehicle has {self._damping.name}, which cannot be undone; give a "
                "positive step, or a vehicle without damping"
            )
        if self.order != 2:
            raise InvalidInputError(
                f"order = {self.order}, but the vehicle has {self._damping.name}: orders above 2 take negative "
                "stages, which cannot undo it; give order 2, or a vehicle without damping"
            )

    def _check_restoring_step(self) -> None:
        """The restoring moment is explicit at the node: stable for h omega < 2."""
        fastest = float(self.restoring_frequencies.max())
        if abs(self.step) * fastest >= 2.0:
            raise InvalidInputError(
                f"step = {self.step:g} s is too large for the restoring moment: h omega = "
                f"{self.step * fastest:.3g} with omega = {fastest:.3g} rad/s must stay below 2; give a step "
                f"below {2.0 / fastest:.3g} s (0.1 of it for accuracy)"
            )


def _rebuild(vehicle: Vehicle, current: list[float], scheme: str, step: float, order: int) -> Scene:
    return Scene(vehicle, current=current, scheme=scheme, step=step, order=order)
