"""A body's physics put together: which functions its step needs, and with which numbers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dq_marine.errors import InvalidInputError
from dq_marine.kernel.composed import STAGES, ComposedTiming, make_composed
from dq_marine.kernel.current import MOVING_WATER, STILL_WATER, UniformCurrent
from dq_marine.kernel.extrapolated import ExtrapolatedTiming, make_extrapolated
from dq_marine.kernel.midpoint_drift import midpoint_drift, midpoint_rescue
from dq_marine.kernel.paper_drift import paper_drift, paper_rescue
from dq_marine.kernel.step import Advance, Composition, StepParameters
from dq_marine.kernel.strang import make_strang
from dq_marine.terms import DampingTerm, ForceTerm, inertia_term, nested_parameters, vector3

SCHEMES = {"midpoint": (midpoint_drift, midpoint_rescue), "paper": (paper_drift, paper_rescue)}
"""Schemes by name: the drift, and its rescue."""

ORDERS = (2, *STAGES)
"""Orders that a method may have."""


@dataclass(frozen=True)
class Assembly:
    """The physics of one body, without a step size yet.

    Attributes:
        mass_matrix: M in Fossen's order, symmetric positive definite, shape (6, 6).
        forces: those that are present.
        damping: may be zero.
        current_ned: velocity of the water [m/s], shape (3,).
        scheme: one of `SCHEMES`.
        order: one of `ORDERS`.
    """

    mass_matrix: NDArray[np.float64]
    forces: tuple[ForceTerm, ...]
    damping: DampingTerm
    current_ned: NDArray[np.float64]
    scheme: str = "midpoint"
    order: int = 2

    def __post_init__(self) -> None:
        """Refuse schemes and orders that are not there, or cannot hold.

        Raises:
            InvalidInputError: with the reason.
        """
        if self.scheme not in SCHEMES:
            raise InvalidInputError(f"scheme = {self.scheme!r} is unknown; give one of {sorted(SCHEMES)}")
        if self.order not in ORDERS:
            raise InvalidInputError(f"order = {self.order!r}; give one of {list(ORDERS)}")
        if self.order > 4 and self.dissipation:
            raise InvalidInputError(
                f"order = {self.order}, but there is {self.dissipation}: orders above 4 take negative stages, which "
                "cannot undo it; give order 2 or 4, or leave it out"
            )

    @property
    def terms(self) -> tuple[str, ...]:
        """Names of what the step computes besides inertia and the control wrench."""
        names = [*(force.name for force in self.forces), self.damping.name]
        return tuple(filter(None, [*names, "current" if self.current_ned.any() else ""]))

    @property
    def dissipation(self) -> str:
        """What takes energy, or may: damping and velocity forces; empty if nothing does."""
        names = [self.damping.name, *(force.name for force in self._velocity_forces)]
        return ", ".join(filter(None, names))

    @property
    def composition(self) -> Composition:
        """The functions of the step."""
        drift, rescue = SCHEMES[self.scheme]
        return Composition(
            method=self._method,
            pose_forces=tuple(force.compiled_form for force in self._pose_forces),
            velocity_forces=tuple(force.compiled_form for force in self._velocity_forces),
            kick=self.damping.kick,
            drift=drift,
            rescue=rescue,
            water=MOVING_WATER if self.current_ned.any() else STILL_WATER,
        )

    def parameters_at(self, step: float) -> StepParameters:
        """Return the numbers of the step for a step size [s]."""
        return StepParameters(
            inertia=inertia_term(self.mass_matrix),
            damping=self.damping.matrices,
            forces=(nested_parameters(self._pose_forces), nested_parameters(self._velocity_forces)),
            water=UniformCurrent(vector3(self.current_ned)) if self.current_ned.any() else (),
            timing=self._timing(step),
        )

    @property
    def _pose_forces(self) -> tuple[ForceTerm, ...]:
        return tuple(force for force in self.forces if not force.uses_velocity)

    @property
    def _velocity_forces(self) -> tuple[ForceTerm, ...]:
        return tuple(force for force in self.forces if force.uses_velocity)

    @property
    def _method(self) -> Callable[[Composition], Advance]:
        if self.order == 2:
            return make_strang
        return make_extrapolated if self.dissipation else make_composed

    def _timing(self, step: float) -> Any:
        """Return what the method needs to know of a step size."""
        if self.order == 2:
            return self.damping.timing(step)
        if self.dissipation:
            return ExtrapolatedTiming(*(self.damping.timing(step / pieces) for pieces in (1, 2, 3)))
        return ComposedTiming(tuple(step * stage for stage in STAGES[self.order]))
