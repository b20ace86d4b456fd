"""The cases: motions that methods are compared on. To add one, write a function and name it in `CASES`."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from dq_marine.algebra.euler import quaternion_from_euler
from dq_marine.algebra.spatial import from_fossen
from dq_marine.physics.term import ForceTerm
from dq_marine.report.case_bodies import SUPPLY_VESSEL_RESTORING, Rexrov, remus_100, supply_vessel
from dq_marine.report.case_forces import (
    Oscillation,
    Waterplane,
    oscillation,
    waterplane,
    waterplane_potential,
)
from dq_marine.report.closed_forms import BroadsideTurn, FreeTop
from dq_marine.report.end_state import EndState
from dq_marine.report.physics import Physics
from dq_marine.simulation.one_body import OneBody
from dq_marine.vehicles import load_vehicle
from dq_marine.vehicles.analysis.lamb import ellipsoid_mass_matrix

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Case:
    """A motion: what acts on a body, and how it starts. 6-vectors in Fossen's order, SI.

    Attributes:
        name: in files and on the command line.
        title: in tables and plots.
        physics: what acts on the body.
        duration: [s].
        conservative: whether nothing takes or adds energy.
        note: what it shows, and where its numbers are from.
        velocity: over ground at the start, body frame, shape (6,).
        position: at the start, NED [m], shape (3,).
        quaternion: at the start, body to NED, shape (4,).
        wrench: constant in the body frame, shape (6,).
        exact: (time) -> where the body is, if there is a closed form; an object whose `repr` has its numbers.
        stiff: whether an explicit solver takes small steps for no other reason than not to blow up.
    """

    name: str
    title: str
    physics: Physics
    duration: float
    conservative: bool
    note: str
    velocity: Array
    position: Array
    quaternion: Array
    wrench: Array
    exact: Callable[[float], EndState] | None = None
    stiff: bool = False

    def place(self, body: OneBody) -> None:
        """Put a body where the motion starts, at time 0."""
        body.reset(self.position, self.quaternion, self.velocity)

    def summary(self) -> dict[str, Any]:
        """Return the numbers as JSON has them, to tell one motion from another."""
        return {
            "physics": self.physics.summary(),
            "position": self.position.tolist(),
            "quaternion": self.quaternion.tolist(),
            "velocity": self.velocity.tolist(),
            "wrench": self.wrench.tolist(),
            "duration": self.duration,
        }


def case(
    name: str,
    title: str,
    physics: Physics,
    duration: float,
    velocity: ArrayLike,
    note: str,
    *,
    conservative: bool = True,
    position: ArrayLike = (0.0, 0.0, 0.0),
    quaternion: ArrayLike = (1.0, 0.0, 0.0, 0.0),
    exact: Callable[[float], EndState] | None = None,
    stiff: bool = False,
) -> Case:
    """Return a case without a constant wrench, at the origin and level where nothing else is said."""
    return Case(
        name=name,
        title=title,
        physics=physics,
        duration=duration,
        conservative=conservative,
        note=note,
        velocity=np.asarray(velocity, dtype=float),
        position=np.asarray(position, dtype=float),
        quaternion=np.asarray(quaternion, dtype=float),
        wrench=np.zeros(6),
        exact=exact,
        stiff=stiff,
    )


def free_top(name: str, title: str, spin: tuple[float, float, float], duration: float, note: str) -> Case:
    """Return a top of moments 1, 2 and 3 kg m^2 that also moves on, in a vacuum."""
    velocity = (0.3, 0.2, 0.1, *spin)
    exact = FreeTop((1.0, 2.0, 3.0), (1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0), velocity)
    physics = Physics(np.diag([1.0, 1.0, 1.0, 1.0, 2.0, 3.0]))
    return case(name, title, physics, duration, velocity, note, exact=exact)


def torque_free_top() -> Case:
    """Return the free top, for two of its periods."""
    spin = (np.pi / 10.0, np.pi / 6.0, np.pi / 8.0)
    note = "A rigid body without water: the classical test of integrators on SO(3). Closed form."
    return free_top("torque_free_top", "Torque-free top", spin, 30.0, note)


def dzhanibekov() -> Case:
    """Return the free top about its middle axis, for some flips."""
    note = "Rotation about the middle axis is unstable: it flips every 11.6 s, and errors grow in between. Closed form."
    return free_top("dzhanibekov", "Dzhanibekov's nut", (0.01, 2.0, 0.0), 30.0, note)


def kirchhoff_bluerov2() -> Case:
    """Return the BlueROV2 Heavy in free motion."""
    physics = Physics(load_vehicle("bluerov2_heavy").mass_matrix)
    note = "Kirchhoff's equations alone: neither weight nor damping, added mass of three different sizes."
    velocity = (0.5, 0.3, 0.2, 0.5, 0.4, 0.6)
    return case("kirchhoff_bluerov2", "BlueROV2 Heavy, free", physics, 10.0, velocity, note)


def kirchhoff_remus() -> Case:
    """Return the REMUS 100 ahead and rolling, in free motion."""
    note = "A slender body at speed: Munk's instability grows at 2.8/s. Numbers: Prestero 2001."
    velocity = (2.0, 0.0, 0.0, 0.5, 0.0, 0.0)
    return case("kirchhoff_remus", "REMUS 100, free", Physics(remus_100()), 4.0, velocity, note)


def munk_spheroid() -> Case:
    """Return the spheroid ahead, slightly across."""
    m = ellipsoid_mass_matrix(0.5, 0.125, 0.125)
    surge, sway = 1.0, 0.05
    exact = BroadsideTurn(m[0, 0], m[1, 1], m[5, 5], surge, sway)
    note = "Munk's instability: a spheroid (4:1, Lamb's added mass) turns broadside and swings. Planar; closed form."
    velocity = (surge, sway, 0.0, 0.0, 0.0, 0.0)
    return case("munk_spheroid", "Spheroid turning broadside", Physics(m), 5.0, velocity, note, exact=exact)


def heavy_top() -> Case:
    """Return the heavy top, let go at a tilt of 30 degrees."""
    physics = Physics(np.diag([10.0, 10.0, 10.0, 0.4, 0.4, 0.2]), arm=np.array([0.0, 0.0, -2.0]))
    note = "A neutral body with its weight above its buoyancy, held up by its spin: it nods and precesses."
    tilted = quaternion_from_euler(np.pi / 6.0, 0.0, 0.0)
    velocity = (0.2, 0.1, 0.0, 0.0, 0.0, 12.0)
    return case("heavy_top", "Heavy top", physics, 10.0, velocity, note, quaternion=tilted)


def coupled_rexrov() -> Case:
    """Return the RexROV without damping, rocking under its righting moment."""
    rexrov = Rexrov()
    physics = Physics(rexrov.mass_matrix, arm=rexrov.arm)
    note = "All 36 entries of M, and a righting moment. Numbers: Berg 2012, as in the UUV Simulator; neutral."
    tilted = quaternion_from_euler(0.3, -0.2, 0.5)
    velocity = (0.8, 0.3, -0.2, 0.1, 0.2, 0.15)
    return case("coupled_rexrov", "RexROV, dense M", physics, 20.0, velocity, note, quaternion=tilted)


THRUST = ForceTerm(
    "oscillating thrust",
    oscillation,
    Oscillation(
        1.5,
        from_fossen((40.0, 10.0, 20.0, 0.6, -0.3, 1.0)),
        from_fossen((0.0, 30.0, -25.0, -0.4, 0.5, 1.0)),
    ),
    uses_pose=False,
)
"""What drives the damped BlueROV2: some 40 N and 1 N m, at 1.5 rad/s, with a phase for each axis."""


def damped_bluerov2(times: int = 1) -> Case:
    """Return the BlueROV2 Heavy with all that acts on it, thrust to and fro, and its damping some times as large."""
    vehicle = load_vehicle("bluerov2_heavy")
    physics = Physics(
        vehicle.mass_matrix,
        vehicle.weight - vehicle.buoyant_force,
        vehicle.restoring_arm,
        times * vehicle.linear_damping,
        times * vehicle.quadratic_damping,
        forces=(THRUST,),
    )
    usual = times == 1
    note = (
        "Weight, buoyancy, linear and quadratic damping, and an oscillating thrust on all axes: what is simulated most."
        if usual
        else f"The same with {times} times the damping: stiff for explicit methods."
    )
    return case(
        "damped_bluerov2" if usual else f"damped_bluerov2_x{times}",
        "BlueROV2 Heavy, damped" if usual else f"BlueROV2 Heavy, damping x {times}",
        physics,
        20.0,
        (0.3, 0.1, -0.1, 0.05, 0.1, 0.2),
        note,
        conservative=False,
        stiff=times > 100,
    )


LINEARISED_AT = 0.5
"""Speed at which the linear damping is as strong as linear and quadratic damping together [m/s, rad/s]."""


def linear_bluerov2() -> Case:
    """Return the BlueROV2 Heavy under the same thrust, with damping in proportion to its velocity."""
    usual = damped_bluerov2()
    physics = usual.physics
    linear = physics.linear + LINEARISED_AT * np.diag(physics.quadratic)
    note = (
        "The same with linear damping, as strong as that of the case before at 0.5 m/s and 0.5 rad/s: without kinks at "
        "the zeros of velocities, which bound the order of most methods there."
    )
    return replace(
        usual,
        name="linear_bluerov2",
        title="BlueROV2 Heavy, linear damping",
        physics=replace(physics, linear=linear, quadratic=np.zeros(6)),
        note=note,
    )


def ship_restoring() -> Case:
    """Return the supply vessel, under way and rocking."""
    restoring = Waterplane(*SUPPLY_VESSEL_RESTORING)
    term = ForceTerm("waterplane", waterplane, restoring, potential=waterplane_potential)
    physics = Physics(supply_vessel(), forces=(term,))
    note = (
        "A force that depends on the position: the restoring of a ship's waterplane. Natural frequencies 0.62 (roll), "
        "0.86 and 0.99 rad/s (heave and pitch). Numbers: Marine Systems Simulator (Fossen, Perez)."
    )
    return case(
        "ship_restoring",
        "Supply vessel, 83 m, rocking",
        physics,
        40.0,
        (3.0, 0.2, 0.0, 0.02, 0.01, 0.01),
        note,
        position=(0.0, 0.0, 0.6),
        quaternion=quaternion_from_euler(0.2, 0.04, 0.3),
    )


CASES = {
    made.name: made
    for made in (
        torque_free_top(),
        dzhanibekov(),
        kirchhoff_bluerov2(),
        kirchhoff_remus(),
        munk_spheroid(),
        heavy_top(),
        coupled_rexrov(),
        damped_bluerov2(),
        linear_bluerov2(),
        damped_bluerov2(30),
        damped_bluerov2(1000),
        ship_restoring(),
    )
}
"""The cases by name."""
