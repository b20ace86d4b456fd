"""Assembles the physics of a body: the functions that its step needs, and their numbers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dq_marine.algebra.spatial import Spatial
from dq_marine.checks import one_of, shown
from dq_marine.errors import InvalidInputError
from dq_marine.integrator.actuation import NO_ACTUATION
from dq_marine.integrator.composed import STAGES, ComposedTiming, make_composed
from dq_marine.integrator.extrapolated import ExtrapolatedTiming, make_extrapolated
from dq_marine.integrator.fluid_memory import NO_MEMORY
from dq_marine.integrator.forces import Forces, Potential
from dq_marine.integrator.kick import Kick
from dq_marine.integrator.midpoint_drift import midpoint_drift, midpoint_fallback
from dq_marine.integrator.paper_drift import paper_drift, paper_fallback
from dq_marine.integrator.richardson import RichardsonTiming, make_richardson
from dq_marine.integrator.step import Advance, Composition, StepParameters
from dq_marine.integrator.strang import StrangTiming, make_strang
from dq_marine.integrator.touching import make_touching
from dq_marine.physics.actuators.build import ActuationTerm
from dq_marine.physics.contact.build import NOTHING_SOLID, ContactTerm
from dq_marine.physics.damping.build import DampingTerm
from dq_marine.physics.matrices import inertia_term
from dq_marine.physics.radiation.build import MemoryTerm
from dq_marine.physics.term import ForceTerm, WaterTerm, nested_parameters
from dq_marine.simulation.stage_schemes import STAGE_SCHEMES, StageScheme

DRIFTS = {"midpoint": (midpoint_drift, midpoint_fallback), "paper": (paper_drift, paper_fallback)}
"""Schemes with a drift, by name: the drift, and its fallback."""

SCHEMES = tuple(sorted([*DRIFTS, *STAGE_SCHEMES]))
"""Names of all schemes."""

ORDERS = (2, *STAGES)
"""Orders that a method may have."""


ONLY_WITH_STAGES = ("gauss", "runge_kutta")
"""Schemes that have no order but those with stages of their own."""


def check_method(scheme: str, order: int) -> None:
    """Refuse what is no scheme, no order, or an order that the scheme does not have.

    Raises:
        InvalidInputError: with the reason.
    """
    one_of("scheme", scheme, SCHEMES)
    if scheme in ONLY_WITH_STAGES and order not in STAGE_SCHEMES[scheme].orders:
        orders = " and ".join(map(str, STAGE_SCHEMES[scheme].orders))
        raise InvalidInputError(
            f"order = {shown(order)}, but scheme = {scheme!r} has orders {orders} alone; give one of them, or another "
            "scheme"
        )
    one_of("order", order, ORDERS)


def compiled_forms(forces: tuple[ForceTerm, ...]) -> tuple[Callable[..., Spatial], ...]:
    """Return the functions of forces, as the step calls them."""
    return tuple(force.compiled_form for force in forces)


class Method(NamedTuple):
    """The sequence of drifts and kicks of one order.

    Attributes:
        make: (composition) -> advance.
        kick: damping, as the method wants it.
        timing: (step size [s]) -> what the method needs to know of it.
    """

    make: Callable[[Composition], Advance]
    kick: Kick
    timing: Callable[[float], Any]


@dataclass(frozen=True)
class Assembly:
    """The physics of one body, without a step size yet.

    Attributes:
        mass_matrix: M in Fossen's order, symmetric positive definite, shape (6, 6).
        forces: those that are present.
        damping: may be zero.
        water: still or moving.
        scheme: one of `SCHEMES`.
        order: one of `ORDERS`.
        actuators: those that drive the body, if any.
        memory: that of the water, if it has one; M is then its own.
        contact: with what is solid.
    """

    mass_matrix: NDArray[np.float64]
    forces: tuple[ForceTerm, ...]
    damping: DampingTerm
    water: WaterTerm
    scheme: str = "midpoint"
    order: int = 2
    actuators: ActuationTerm | None = None
    memory: MemoryTerm | None = None
    contact: ContactTerm = NOTHING_SOLID

    def __post_init__(self) -> None:
        """Check the scheme and the order.

        Raises:
            InvalidInputError: with the reason.
        """
        check_method(self.scheme, self.order)
        if self.scheme == "gauss" and self.order == 6 and self.damping.names:
            raise InvalidInputError(
                "order = 6, but with damping scheme = 'gauss' is Radau's collocation, of order 7; give order=8, which "
                "stands for it"
            )
        if self.memory is not None and self._stage_scheme:
            raise InvalidInputError(
                f'scheme = {self.scheme!r} of order {self.order} knows no radiation memory; give scheme="midpoint" of '
                'order 2 or 4, or radiation="constant"'
            )
        if self.contact.name and (self.order != 2 or self._stage_scheme):
            raise InvalidInputError(
                f"scheme = {self.scheme!r} of order {self.order} knows no contact, which is of low order; "
                'give scheme="midpoint", order=2, or leave the solids out'
            )
        if self.order > 4 and self.dissipation and not self._stage_scheme:
            raise InvalidInputError(
                f"order = {self.order}, but there is {self.dissipation}: orders above 4 take negative stages, which "
                "cannot undo it; give order 2 or 4, or leave it out"
            )

    @property
    def terms(self) -> tuple[str, ...]:
        """Names of what the step computes besides inertia and the control wrench."""
        names = [
            *(force.name for force in self._present(0.0)),
            *self.damping.names,
            self._memory_name,
            self.contact.name,
            self.water.name,
        ]
        return tuple(filter(None, names))

    @property
    def dissipation(self) -> str:
        """Names of what takes energy, or may: damping, memory and velocity forces; empty if nothing does."""
        names = [
            *self.damping.names,
            self._memory_name,
            self.contact.name,
            *(force.name for force in self._velocity_forces(0.0)),
        ]
        return ", ".join(filter(None, names))

    @property
    def composition(self) -> Composition:
        """The functions of the step."""
        if self._stage_scheme:
            strang = replace(self, scheme="midpoint", order=2).composition
            return self._stage_scheme.compose(strang, self.order, self.damping, self._potentials)
        drift, fallback = DRIFTS["midpoint" if self.scheme == "galerkin" else self.scheme]
        return Composition(
            method=self._method.make,
            pose_forces=compiled_forms(self._pose_forces(0.0)),
            velocity_forces=compiled_forms(self._velocity_forces(0.0)),
            kick=self._method.kick,
            drift=drift,
            fallback=fallback,
            water=self.water.water,
            actuation=NO_ACTUATION if self.actuators is None else self.actuators.actuation,
            time_forces=compiled_forms(self._time_forces(0.0)),
            memory=NO_MEMORY if self.memory is None else self.memory.memory,
            contact=self.contact.contact,
        )

    def parameters_at(self, step: float) -> StepParameters:
        """Return the numbers of the step for a step size [s]."""
        return StepParameters(
            inertia=inertia_term(self.mass_matrix),
            damping=self.damping.matrices,
            forces=Forces(
                nested_parameters(self._time_forces(step)),
                nested_parameters(self._pose_forces(step)),
                nested_parameters((*self._velocity_forces(step), *self._drag)),
            ),
            water=self.water.parameters,
            timing=self._timing(step),
            contact=self.contact.parameters,
        )

    def _timing(self, step: float) -> Any:
        if self._stage_scheme:
            return self._stage_scheme.timing(self.damping, step)
        return self._method.timing(step)

    @property
    def _memory_name(self) -> str:
        return "" if self.memory is None else "radiation memory"

    def _strang_timing(self, step: float) -> StrangTiming:
        timing = self.damping.timing(step)
        return timing if self.memory is None else timing._replace(memory=self.memory.numbers(0.5 * step))

    def _present(self, step: float) -> tuple[ForceTerm, ...]:
        """Return all forces; the actuators' first, where `physics.actuators.formulas.stepping` finds it."""
        return self.forces if self.actuators is None else (self.actuators.force_at(step), *self.forces)

    def _time_forces(self, step: float) -> tuple[ForceTerm, ...]:
        return tuple(force for force in self._present(step) if force.kind == "time")

    def _pose_forces(self, step: float) -> tuple[ForceTerm, ...]:
        return tuple(force for force in self._present(step) if force.kind == "pose")

    def _velocity_forces(self, step: float) -> tuple[ForceTerm, ...]:
        return tuple(force for force in self._present(step) if force.kind == "velocity")

    @property
    def _potentials(self) -> tuple[Potential, ...]:
        """Of all forces; none if one force has none, or something damps."""
        if self.damping.names:
            return ()
        found = tuple(force.potential for force in self._present(0.0) if force.potential is not None)
        return found if len(found) == len(self._present(0.0)) else ()

    @property
    def _stage_scheme(self) -> StageScheme | None:
        """The scheme, if it takes steps of this order with stages: Galerkin's of order 2 is the midpoint scheme."""
        scheme = STAGE_SCHEMES.get(self.scheme)
        return scheme if scheme and self.order in scheme.orders else None

    @property
    def _drag(self) -> tuple[ForceTerm, ...]:
        """Damping as a force, where the scheme takes it as one."""
        return self.damping.drag if self._stage_scheme else ()

    @property
    def _method(self) -> Method:
        damping = self.damping
        if self.order == 2:
            return Method(
                make_touching if self.contact.name else make_strang, damping.kick, self._strang_timing
            )
        if not self.dissipation:
            stages = STAGES[self.order]
            return Method(
                make_composed, damping.kick, lambda h: ComposedTiming(tuple(h * stage for stage in stages))
            )
        if self._velocity_forces(0.0):
            return Method(
                make_extrapolated,
                damping.kick,
                lambda h: ExtrapolatedTiming(*(self._strang_timing(h / pieces) for pieces in (1, 2, 3))),
            )
        return Method(
            make_richardson,
            damping.accurate_kick,
            lambda h: RichardsonTiming(*(self._strang_timing(h / pieces) for pieces in (1, 2))),
        )
