"""A scene: a vehicle in water, checked once, from which a specialised stepper is made."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from dq_marine.actuation_term import ACTUATIONS, actuation_term
from dq_marine.assembly import Assembly
from dq_marine.checks import finite_number
from dq_marine.currents import CurrentLike, GaussMarkovCurrent, UniformCurrent, current_of, plain
from dq_marine.damping_term import vehicle_damping
from dq_marine.errors import InvalidInputError
from dq_marine.kernel.dual_quaternion import pose_from_parts
from dq_marine.kernel.spatial import Spatial
from dq_marine.kernel.step import Composition, StepParameters
from dq_marine.restoring_terms import checked_hydrostatics, hydrostatic_terms, natural_frequencies
from dq_marine.terms import ForceTerm
from dq_marine.vehicles import Vehicle, load_vehicle
from dq_marine.weather import weather_of, weather_terms

if TYPE_CHECKING:
    from dq_marine.engines.batch import Batch
    from dq_marine.engines.one_body import OneBody

KICKS = ("l_stable", "implicit_node")
"""How damping is taken in, by name."""


class Scene:
    """A vehicle in water, still or moving, with a scheme and a step.

    Everything is checked here, once. What the vehicle or the water lacks (current, damping, quadratic damping,
    net weight, righting moment, off-diagonal damping) is left out of the step: neither computed nor compiled.

    Attributes:
        vehicle: the validated vehicle.
        current: uniform and steady, or one that varies.
        step: step size h [s].
        kick: how damping is taken in.
        hydrostatics: how buoyancy is computed.
        weather: sea and wind.
        forces: of the user's own.
        actuation: what drives the vehicle.
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
        actuation: str = "wrench",
    ) -> None:
        """Check and compose the scene.

        Args:
            vehicle: a catalogue name, the path of a TOML file, or a `Vehicle`.
            current: velocity of the water in NED, shape (3,) [m/s]; or a `dq_marine.currents.CurrentProfile` or
                `GaussMarkovCurrent`, or a dictionary of its attributes.
            scheme: the drift: "midpoint", or "paper" for that of Xu & Halse.
            step: step size h [s]; negative runs time backwards, in a scene that takes no energy.
            order: of the method: 2 or 4, and 6 or 8 in a scene that takes no energy.
            kick: "l_stable", or "implicit_node", which keeps the step symmetric but rings under stiff damping.
            hydrostatics: "linear": of a vessel that floats, its waterplane's restoring force for small motions, and of
                any other, weight and buoyancy under water; or "hull": buoyancy of the boxes of its hull at any depth
                and attitude, so that it may capsize, dive or leave the water.
            weather: seas and winds, see `dq_marine.weather`.
            forces: of your own, see `dq_marine.terms.ForceTerm`.
            actuation: "wrench", a force and moment on the body; or "thrusters", the vehicle's thrusters, azimuths and
                fins, with their limits and lags: see `ActuatedBody.actuate`.

        Raises:
            InvalidInputError: a value is wrong, the step is too large for the vehicle's restoring forces, or the
                vehicle has no actuators whose forces are known.
            VehicleFileError: the vehicle file is wrong.
        """
        self.vehicle = load_vehicle(vehicle)
        self.current = current_of(current)
        self.step = finite_number("step", step)
        if kick not in KICKS:
            raise InvalidInputError(f"kick = {kick!r} is unknown; give one of {list(KICKS)}")
        self.kick = kick
        self.hydrostatics = checked_hydrostatics(hydrostatics, self.vehicle)
        if actuation not in ACTUATIONS:
            raise InvalidInputError(f"actuation = {actuation!r} is unknown; give one of {list(ACTUATIONS)}")
        self.actuation = actuation
        self.weather = weather_of(weather)
        self.forces = checked_forces(forces)
        self._check_restoring_step()
        mass_matrix = self.vehicle.mass_matrix
        damping = vehicle_damping(self.vehicle, l_stable=kick == "l_stable")
        restoring = hydrostatic_terms(self.vehicle, self.hydrostatics)
        of_weather = checked_forces(weather_terms(self.weather, self.vehicle, self.current_ned))
        present = (*restoring, *of_weather, *self.forces)
        actuators = actuation_term(self.vehicle) if actuation == "thrusters" else None
        water = self.current.term(self.vehicle)
        self._assembly = Assembly(mass_matrix, present, damping, water, scheme, order, actuators=actuators)
        self._check_direction_of_time()

    def __repr__(self) -> str:
        current = plain(self.current)
        terms = ", ".join(self.terms) or "nothing"
        return (
            f"Scene({self.vehicle.name!r}, current={current}, scheme={self.scheme!r}, step={self.step:g}, "
            f"order={self.order}, kick={self.kick!r}, hydrostatics={self.hydrostatics!r}, "
            f"actuation={self.actuation!r}; computes {terms})"
        )

    def __reduce__(self) -> Any:
        """Travel as the arguments: a composition's functions are made anew where the scene arrives."""
        arguments = {
            "vehicle": self.vehicle,
            "current": plain(self.current),
            "scheme": self.scheme,
            "step": self.step,
            "order": self.order,
            "kick": self.kick,
            "hydrostatics": self.hydrostatics,
            "weather": self.weather,
            "forces": self.forces,
            "actuation": self.actuation,
        }
        return _rebuild, (arguments,)

    @property
    def current_ned(self) -> NDArray[np.float64]:
        """Velocity of the water [m/s], shape (3,): of a profile the uppermost, of a process the mean."""
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

        With `actuation="thrusters"` it is an `ActuatedBody`, whose actuators are at rest, too.
        """
        from dq_marine.engines.actuated_body import body_of  # here: it imports Numba

        return body_of(self.composition, self.parameters_at, self.step)

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

    What is the same in all scenes is stored and loaded once; what differs, for each body.

    Args:
        scenes: one for each body, alike in what they compute and in their step; or a single one for `size` bodies.
        size: number of bodies, with a single scene.
        threads: see `Scene.batch`.
        precision: see `Scene.batch`.
        arithmetic: see `Scene.batch`.

    Raises:
        InvalidInputError: the scenes differ in their terms or step, a value is wrong, or a current changes with time.
    """
    from dq_marine.engines.actuated_batch import batch_type  # here: it imports Numba

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
    return batch_type(first.composition)(
        first.composition,
        [scene.parameters_at(scene.step) for scene in scenes],
        first.step,
        len(scenes) if size is None else size,
        threads=threads,
        precision=precision,
        arithmetic=arithmetic,
    )


def checked_forces(forces: Sequence[ForceTerm]) -> tuple[ForceTerm, ...]:
    """Return the forces, each checked by `checked_force`.

    Raises:
        InvalidInputError: one is wrong, or they are no sequence.
    """
    if isinstance(forces, ForceTerm) or not isinstance(forces, Sequence):
        raise InvalidInputError(f"forces = {forces!r}; give a list of dq_marine.terms.ForceTerm")
    return tuple(checked_force(force) for force in forces)


def checked_force(force: ForceTerm) -> ForceTerm:
    """Return the force if it gives a finite wrench for a body at rest.

    Raises:
        InvalidInputError: it is no `ForceTerm`, or its function does not take or return what it should.
    """
    if not isinstance(force, ForceTerm):
        raise InvalidInputError(
            f"forces has {force!r}; give dq_marine.terms.ForceTerm(name, function, parameters)"
        )
    pose = pose_from_parts((1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    rest = Spatial((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    arguments = (pose, rest, 0.0) if force.uses_velocity else (pose, 0.0)
    try:
        wrench = force.function(force.parameters, *arguments)
        finite = bool(np.isfinite([*wrench.angular, *wrench.linear]).all())
    except Exception as error:
        raise InvalidInputError(
            f"force {force.name!r} cannot be evaluated at rest: {type(error).__name__}: {error}; its function takes "
            f"(parameters, pose, {'twist, ' if force.uses_velocity else ''}time) and returns Spatial(moment, force)"
        ) from error
    if not finite:
        raise InvalidInputError(f"force {force.name!r} gives {wrench} at rest; it must be finite")
    return force


def _rebuild(arguments: dict[str, Any]) -> Scene:
    return Scene(**arguments)
