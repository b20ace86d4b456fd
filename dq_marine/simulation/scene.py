"""A scene: a vehicle in water, checked once, which makes a stepper with only the terms that it needs."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from dq_marine.checks import finite_array, finite_number, positive_integer, shown
from dq_marine.errors import InvalidInputError
from dq_marine.integrator.step import Composition, StepParameters
from dq_marine.physics.abkowitz.build import whole_ship_terms
from dq_marine.physics.actuators.build import actuation_term
from dq_marine.physics.contact.build import contact_term
from dq_marine.physics.contact.solid import Solid
from dq_marine.physics.current.build import (
    Current,
    CurrentLike,
    DrawnCurrent,
    GaussMarkovCurrent,
    UniformCurrent,
    plain,
)
from dq_marine.physics.damping.build import vehicle_damping
from dq_marine.physics.hydrostatics.build import hydrostatic_terms, natural_frequencies
from dq_marine.physics.manoeuvring.build import manoeuvring_terms
from dq_marine.physics.radiation.build import memory_term
from dq_marine.physics.term import ForceTerm, checked_forces
from dq_marine.physics.weather import weather_terms
from dq_marine.physics.weather.choice import Weather
from dq_marine.simulation.assembly import Assembly
from dq_marine.simulation.settings import Settings
from dq_marine.vehicles import Vehicle

if TYPE_CHECKING:
    from dq_marine.simulation.batch import Batch
    from dq_marine.simulation.one_body import OneBody


class Scene:
    """A vehicle in water, still or moving, with a scheme and a step.

    Everything is checked here, once. Terms that the vehicle or the water lacks (current, damping, quadratic
    damping, net weight, righting moment, off-diagonal damping) are neither computed nor compiled.

    Attributes:
        settings: what it was made from; `vehicle`, `current` and the others are read from there.
    """

    def __init__(
        self,
        vehicle: Vehicle | str | os.PathLike[str] = "bluerov2_heavy",
        *,
        current: CurrentLike = (0.0, 0.0, 0.0),
        scheme: str = "midpoint",
        step: float = 0.02,
        order: int = 2,
        kick: str = "l_stable",
        hydrostatics: str = "linear",
        weather: Sequence[Any] = (),
        forces: Sequence[ForceTerm] = (),
        solids: Sequence[Any] = (),
        actuation: str = "wrench",
        gravity: float | None = None,
        radiation: str = "constant",
    ) -> None:
        """Check and compose the scene.

        Args:
            vehicle: a catalogue name, the path of a TOML file, or a `Vehicle`.
            current: velocity of the water in NED, shape (3,) [m/s]; or a
                `dq_marine.CurrentProfile` or `dq_marine.GaussMarkovCurrent`, or a dictionary of its attributes.
            scheme: "midpoint"; "paper" for that of Xu & Halse; "galerkin" for the variational integrators whose orders
                above 2 need no substeps; "gauss" for collocation on the momentum: without damping exact in momentum
                and energy but not variational, with damping L-stable; or "runge_kutta" for an explicit method, the
                cheapest for a batch that is to be exact and is not stiff.
            step: step size h [s]; a negative one runs time backwards, in a scene without dissipation.
            order: order of the method: 2 or 4; or 6 or 8 in a scene without damping and velocity forces, or with
                "galerkin" in any; 6 or 8 of "gauss", where 8 is of order 7 with damping, and 6 is without
                damping only; 4 or 8 of "runge_kutta".
            kick: "l_stable", or "implicit_node", which keeps the step symmetric but rings under stiff damping.
            hydrostatics: "linear": for a vessel that floats, its waterplane's restoring force for small motions, and
                for any other vehicle, weight and buoyancy under water; or "hull": buoyancy of the boxes of its hull at
                any depth and attitude, so that it may capsize, dive or leave the water.
            weather: seas and winds, see `dq_marine.physics.weather`.
            forces: your own forces, see `dq_marine.ForceTerm`.
            solids: what the hull cannot pass, see `dq_marine.Solid`; needs order 2 and a scheme without stages.
            actuation: "wrench", a force and moment on the body; or "thrusters", the vehicle's thrusters, azimuths and
                fins, with their limits and lags: see `OneBody.actuate`.
            gravity: g [m/s^2], which weight, buoyancy and the lengths of waves follow; None for the vehicle's own, 9.81
                where its file says nothing.
            radiation: how the waves that a hull makes act on it. "constant": by the constant added mass and damping of
                its file. "memory": by those of all frequencies, for a vehicle whose file has them: see
                `dq_marine.physics.radiation.model`. They are those of a hull without way on, and hold for small speeds.

        Raises:
            InvalidInputError: a value is wrong, the step is too large for the vehicle's restoring forces, or the
                vehicle has no actuators whose forces are known.
            VehicleFileError: the vehicle file is wrong.
        """
        settings = Settings(
            vehicle=vehicle,
            current=finite_array("current", current, 3) if np.isscalar(current) else current,
            weather=weather,
            forces=forces,
            solids=solids,
            actuation=actuation,
            hydrostatics=hydrostatics,
            scheme=scheme,
            order=order,
            kick=kick,
            gravity=gravity,
            radiation=radiation,
            control_period=finite_number("step", step),
            substeps=1,
        )
        self._compose(settings)

    @classmethod
    def from_settings(cls, settings: Settings) -> Scene:
        """Return the scene of settings; what concerns agents alone, such as sensors, plays no part.

        Raises:
            InvalidInputError: the step is too large for the vehicle's restoring forces, or the vehicle has no actuators
                whose forces are known.
        """
        scene = cls.__new__(cls)
        scene._compose(settings)
        return scene

    def _compose(self, settings: Settings) -> None:
        self.settings = settings
        self._check_restoring_step()
        mass_matrix = self.vehicle.mass_matrix
        damping = vehicle_damping(self.vehicle, l_stable=self.kick == "l_stable")
        memory = memory_term(self.vehicle, settings.radiation)
        if memory is not None:
            mass_matrix = memory.mass_matrix
            viscous = self.vehicle.linear_damping_without_waves
            damping = damping._replace(linear=viscous, mass_matrix=mass_matrix)
        restoring = hydrostatic_terms(self.vehicle, self.hydrostatics)
        of_weather = checked_forces(weather_terms(self.weather, self.vehicle, self.current_ned))
        ships = (*manoeuvring_terms(self.vehicle), *whole_ship_terms(self.vehicle))
        present = (*restoring, *ships, *of_weather, *self.forces)
        actuators = actuation_term(self.vehicle) if self.actuation == "thrusters" else None
        water = self.current.term(self.vehicle)
        self._assembly = Assembly(
            mass_matrix,
            present,
            damping,
            water,
            settings.scheme,
            settings.order,
            actuators,
            memory,
            contact_term(self.vehicle, self.solids),
        )
        self._check_direction_of_time()

    def __repr__(self) -> str:
        current = plain(self.current)
        terms = ", ".join(self.terms) or "nothing"
        return (
            f"Scene({self.vehicle.name!r}, current={current}, scheme={self.scheme!r}, step={self.step:g}, "
            f"order={self.order}, kick={self.kick!r}, hydrostatics={self.hydrostatics!r}, "
            f"actuation={self.actuation!r}, gravity={self.gravity:g}, radiation={self.radiation!r}; computes {terms})"
        )

    def __reduce__(self) -> Any:
        """Travel as settings: a composition's functions are made anew where the scene arrives."""
        return Scene.from_settings, (self.settings,)

    @property
    def vehicle(self) -> Vehicle:
        """The validated vehicle."""
        return self.settings.flown

    @property
    def current(self) -> Current:
        """Uniform and steady, drawn for each episode, or one that varies."""
        return self.settings.water

    @property
    def step(self) -> float:
        """Step size h [s]."""
        return self.settings.step

    @property
    def kick(self) -> str:
        """How damping is taken in."""
        return self.settings.kick

    @property
    def hydrostatics(self) -> str:
        """How buoyancy is computed."""
        return self.settings.hydrostatics

    @property
    def weather(self) -> tuple[Weather, ...]:
        """Sea and wind."""
        return tuple(self.settings.weather)

    @property
    def forces(self) -> tuple[ForceTerm, ...]:
        """The user's own."""
        return tuple(self.settings.forces)

    @property
    def solids(self) -> tuple[Solid, ...]:
        """What the hull cannot pass."""
        return tuple(self.settings.solids)

    @property
    def actuation(self) -> str:
        """What drives the vehicle."""
        return self.settings.actuation

    @property
    def gravity(self) -> float:
        """Acceleration of gravity [m/s^2]."""
        return self.vehicle.gravity

    @property
    def radiation(self) -> str:
        """How the waves that the hull makes act on it."""
        return self.settings.radiation

    @property
    def current_ned(self) -> NDArray[np.float64]:
        """Velocity of the water [m/s], shape (3,): of a profile the uppermost, of a process the mean, 0 if drawn."""
        if isinstance(self.current, DrawnCurrent):
            return np.zeros(3)
        if isinstance(self.current, UniformCurrent):
            return np.array(self.current.velocity_ned)
        if isinstance(self.current, GaussMarkovCurrent):
            return np.array(self.current.mean)
        return self.current.at(self.current.depths[0])

    @property
    def scheme(self) -> str:
        """Name of the drift."""
        return self._assembly.scheme

    @property
    def order(self) -> int:
        """Order of the method."""
        return self._assembly.order

    @property
    def terms(self) -> tuple[str, ...]:
        """Names of what the step computes besides inertia and the control wrench."""
        return self._assembly.terms

    @property
    def composition(self) -> Composition:
        """The functions of the step."""
        return self._assembly.composition

    def parameters_at(self, step: float) -> StepParameters:
        """Return the numbers of the step for a step size [s]."""
        return self._assembly.parameters_at(step)

    def stepper(self) -> OneBody:
        """Return a body at rest at the world's origin, with the step compiled for this scene.

        With `actuation="thrusters"` its actuators are at rest, too.
        """
        from dq_marine.simulation.one_body import OneBody  # here: it imports Numba

        return OneBody(self.composition, self.parameters_at, self.step)

    def batch(
        self,
        size: int,
        *,
        threads: int | None = None,
        precision: str = "float64",
        arithmetic: str = "strict",
    ) -> Batch:
        """Return many bodies at rest at the world's origin, with the step compiled for SIMD lanes.

        Args:
            size: number of bodies.
            threads: None for as many as pay: up to all cores that the process may use.
            precision: "float64" or "float32", of which a vector holds twice as many.
            arithmetic: "strict", with the bits of a single body, or "fast": multiply-adds are fused and sums
                reordered, with other rounding errors.

        Raises:
            InvalidInputError: a value is wrong, or the current changes with time.
        """
        return batch_of([self], size, threads=threads, precision=precision, arithmetic=arithmetic)

    @property
    def restoring_frequencies(self) -> NDArray[np.float64]:
        """Undamped natural angular frequencies [rad/s] about the stable upright or inverted attitude, shape (2,).

        Eigenfrequencies of roll and pitch with the other axes free to follow, from the full M. Shape (3,), heave
        included, of a vessel that floats.
        """
        return natural_frequencies(self.vehicle, self.hydrostatics)

    def _check_direction_of_time(self) -> None:
        if self.step == 0.0:
            raise InvalidInputError(
                "step = 0 s; give a positive step, or a negative one to run time backwards"
            )
        if self.step < 0.0 and self._assembly.dissipation:
            raise InvalidInputError(
                f"step = {self.step:g} s, but there is {self._assembly.dissipation}, which cannot be undone; give a "
                "positive step, or leave it out"
            )
        if self.step < 0.0 and self.actuation != "wrench":
            raise InvalidInputError(
                f"step = {self.step:g} s, but the lags of actuators cannot be undone; give a positive step, or "
                'actuation="wrench"'
            )

    def _check_restoring_step(self) -> None:
        """Restoring forces are explicit at the node: stable for h omega < 2."""
        fastest = float(self.restoring_frequencies.max())
        if abs(self.step) * fastest >= 2.0:
            raise InvalidInputError(
                f"step = {self.step:g} s is too large for the restoring forces: h omega = "
                f"{self.step * fastest:.3g} with omega = {fastest:.3g} rad/s must stay below 2; give a step "
                f"below {2.0 / fastest:.3g} s (0.1 of it for accuracy)"
            )


def batch_of(
    scenes: Sequence[Scene],
    size: int | None = None,
    *,
    threads: int | None = None,
    precision: str = "float64",
    arithmetic: str = "strict",
) -> Batch:
    """Return bodies of different vehicles and currents, at rest at the world's origin, in SIMD lanes.

    Numbers that are the same in all scenes are stored and loaded once; those that differ, for each body.

    Args:
        scenes: one for each body, alike in what they compute and in their step; or a single one for `size` bodies.
        size: number of bodies, with a single scene.
        threads: see `Scene.batch`.
        precision: see `Scene.batch`.
        arithmetic: see `Scene.batch`.

    Raises:
        InvalidInputError: the scenes differ in their terms or step, a value is wrong, or a current changes with time.
    """
    from dq_marine.simulation.batch import Batch  # here: it imports Numba

    if not isinstance(scenes, Sequence) or not all(isinstance(scene, Scene) for scene in scenes):
        raise InvalidInputError(f"scenes = {shown(scenes)}; give a list of dq_marine.Scene")
    size = None if size is None else positive_integer("number of bodies", size)
    if not scenes or (size is not None and len(scenes) not in (1, size)):
        raise InvalidInputError(f"{len(scenes)} scenes for {size} bodies; give one, or one for each body")
    first = scenes[0]
    if isinstance(first.current, GaussMarkovCurrent):
        raise InvalidInputError(
            f"current = {first.current}, but a batch has no control periods in which it could change; give a steady "
            "one, or make environments with gym.make_vec"
        )
    if any(scene.composition != first.composition or scene.step != first.step for scene in scenes):
        raise InvalidInputError(
            "the scenes of a batch differ in what they compute, or in their step; give scenes of equal terms, "
            "scheme, order, kick and step (a term that is zero is left out: give it a tiny value)"
        )
    return Batch(
        first.composition,
        [scene.parameters_at(scene.step) for scene in scenes],
        first.step,
        len(scenes) if size is None else size,
        threads=threads,
        precision=precision,
        arithmetic=arithmetic,
    )
