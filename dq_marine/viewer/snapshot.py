"""What the viewer is told: the shape of a vehicle, and one snapshot of its motion.

Both are plain, frozen data without any drawing library, so that a simulation can record them anywhere.
World frame: NED (north, east, down). Body frame: forward, starboard, down.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np
from numpy.typing import NDArray

from dq_marine.checks import finite_array, finite_number, shown, unit_quaternion
from dq_marine.errors import InvalidInputError
from dq_marine.physics.waves.sea import Sea
from dq_marine.task.things import Beam, Form, Thing
from dq_marine.vehicles.appearance import Appearance

FloatArray = NDArray[np.float64]
ShapeKind = Literal["open_frame", "torpedo", "ellipsoid", "catamaran", "ship"]

SNAPSHOT_ARRAYS = {
    "position_ned": 3,
    "quaternion_body_to_ned": 4,
    "wrench_body": 6,
    "current_ned": 3,
    "wind_ned": 3,
    "goal_position_ned": 3,
    "goal_quaternion_body_to_ned": 4,
}
"""Numbers in each array of a snapshot; the fours are unit quaternions."""

OPTIONAL = ("wind_ned", "goal_position_ned", "goal_quaternion_body_to_ned")
"""Those that may be None."""

UNIT_TOLERANCE = 1e-6
"""Of the length of directions: what is drawn at a distance along them is as far off."""


@dataclass(frozen=True, eq=False)
class Thrust:
    """The force of one actuator on the vehicle.

    Attributes:
        position_body: where it acts in body axes [m], shape (3,).
        force_body: in body axes [N], shape (3,).

    Raises:
        InvalidInputError: a wrong size, or a value that is not finite.
    """

    position_body: FloatArray
    force_body: FloatArray

    def __post_init__(self) -> None:
        for name in ("position_body", "force_body"):
            _set_read_only(self, name, finite_array(f"thrust {name}", getattr(self, name), 3))


@dataclass(frozen=True, eq=False)
class Snapshot:
    """Vehicle, water and goal at one instant.

    Arrays are copied, read-only and float64; quaternions are normalised.

    Attributes:
        time: simulated time [s].
        position_ned: vehicle origin in the world [m], shape (3,).
        quaternion_body_to_ned: attitude (w, x, y, z), unit, shape (4,).
        wrench_body: applied force and moment [X, Y, Z, K, M, N] in body axes [N, N m], shape (6,).
        current_ned: velocity of the water [m/s], shape (3,).
        goal_position_ned: where the vehicle should go [m], shape (3,), or None without a goal.
        goal_quaternion_body_to_ned: the attitude wanted there, shape (4,), or None for any attitude.
        thrusts: the force of each actuator, where they are known one by one; `wrench_body` is of all.
        wind_ned: velocity of the mean wind [m/s], shape (3,), or None without wind.
        things: what is around the vehicle.
        beams: of range sensors, with what they tell; the marks of their echoes are drawn at the distances told.
        sea: the waves; None for a calm surface.
        sea_start: time of the sea when `time` is 0 [s].

    Raises:
        InvalidInputError: a wrong size, a value that is not finite, or a quaternion or direction that is not unit.
    """

    time: float
    position_ned: FloatArray
    quaternion_body_to_ned: FloatArray
    wrench_body: FloatArray
    current_ned: FloatArray
    goal_position_ned: FloatArray | None = None
    goal_quaternion_body_to_ned: FloatArray | None = None
    thrusts: tuple[Thrust, ...] = ()
    wind_ned: FloatArray | None = None
    things: tuple[Thing, ...] = ()
    beams: tuple[Beam, ...] = ()
    sea: Sea | None = None
    sea_start: float = 0.0

    def __post_init__(self) -> None:
        for name in ("time", "sea_start"):
            if not math.isfinite(getattr(self, name)):
                raise InvalidInputError(
                    f"{name} is {getattr(self, name)}; give a finite simulated time in seconds"
                )
        for name, size in SNAPSHOT_ARRAYS.items():
            value = getattr(self, name)
            if value is None and name in OPTIONAL:
                continue
            checked = unit_quaternion(name, value) if size == 4 else finite_array(name, value, size)
            _set_read_only(self, name, checked)
        for number, thrust in enumerate(self.thrusts):
            if not isinstance(thrust, Thrust):
                raise InvalidInputError(
                    f"thrusts[{number}] is {shown(thrust)}; give a dq_marine.viewer.snapshot.Thrust"
                )
        for number, thing in enumerate(self.things):
            if not isinstance(thing, Thing) or not isinstance(thing.form, Form):
                raise InvalidInputError(
                    f"things[{number}] is {shown(thing)}; give a dq_marine.task.things.Thing"
                )
            finite_array(f"things[{number}].position_ned", thing.position_ned, 3)
            unit_quaternion(f"things[{number}].attitude", thing.attitude)
        for number, beam in enumerate(self.beams):
            _check_beam(f"beams[{number}]", beam)


def at_rest(depth: float) -> Snapshot:
    """Return a vehicle at rest in still water, level, heading north, at a depth [m]."""
    return Snapshot(
        time=0.0,
        position_ned=np.array([0.0, 0.0, depth]),
        quaternion_body_to_ned=np.array([1.0, 0.0, 0.0, 0.0]),
        wrench_body=np.zeros(6),
        current_ned=np.zeros(3),
    )


@dataclass(frozen=True, eq=False)
class Thruster:
    """Where a thruster sits and which way it pushes.

    Attributes:
        position: centre in body axes [m], shape (3,).
        direction: direction of positive thrust in body axes, shape (3,); any non-zero length.

    Raises:
        InvalidInputError: a wrong size, a value that is not finite, or a direction of zero length.
    """

    position: FloatArray
    direction: FloatArray

    def __post_init__(self) -> None:
        for name in ("position", "direction"):
            _set_read_only(self, name, finite_array(f"thruster {name}", getattr(self, name), 3))
        if not np.linalg.norm(self.direction) > 0.0:
            raise InvalidInputError(
                f"thruster direction is {self.direction.tolist()}; give a vector of non-zero length"
            )


@dataclass(frozen=True, eq=False)
class Shape:
    """The outer form of a vehicle: all that is needed to draw it.

    Attributes:
        length: along body x [m].
        width: along body y [m].
        height: along body z [m].
        thrusters: drawn one by one; may be empty.
        max_force: force [N] at which the arrow of the net thrust has its full length.
        max_thrust: the same of the arrow of one actuator; None for `max_force`.
        kind: `open_frame` (a work-class or inspection ROV), `torpedo` (an AUV: a body of revolution with
            fins), `ellipsoid`, or afloat `catamaran` or `ship`.
        draft: depth of the keel below the origin [m]; None for half the height.
        appearance: a mesh to draw in place of the kind's picture and thrusters.

    Raises:
        InvalidInputError: a dimension or force that is not positive, or an unknown kind.
    """

    length: float
    width: float
    height: float
    thrusters: tuple[Thruster, ...] = ()
    max_force: float = 100.0
    kind: ShapeKind = "open_frame"
    draft: float | None = None
    max_thrust: float | None = None
    appearance: Appearance | None = None

    def __post_init__(self) -> None:
        for name in ("length", "width", "height", "max_force", "draft", "max_thrust"):
            value = getattr(self, name)
            if name in ("draft", "max_thrust") and value is None:
                continue
            if not (math.isfinite(value) and value > 0.0):
                raise InvalidInputError(f"shape {name} is {value}; give a finite number above 0")
        if self.kind not in get_args(ShapeKind):
            raise InvalidInputError(
                f"shape kind is {self.kind!r}; give one of {', '.join(get_args(ShapeKind))}"
            )

    @property
    def keel(self) -> float:
        """Depth of the keel below the origin [m]."""
        return 0.5 * self.height if self.draft is None else self.draft

    @property
    def floats(self) -> bool:
        """Whether it is a kind of vessel that is at home on the surface."""
        return self.kind in ("catamaran", "ship")

    @property
    def size(self) -> float:
        """The largest dimension [m]."""
        return max(self.length, self.width, self.height)


def _check_beam(name: str, beam: Beam) -> None:
    """Check a beam of a snapshot.

    Raises:
        InvalidInputError: it is none, its direction is not unit, or its distance not within 0 and its reach.
    """
    if not isinstance(beam, Beam):
        raise InvalidInputError(f"{name} is {shown(beam)}; give a dq_marine.task.things.Beam")
    reach = finite_number(f"{name}.reach", beam.reach, above=0.0)
    finite_number(f"{name}.distance", beam.distance, least=0.0, most=reach)
    finite_array(f"{name}.origin_body", beam.origin_body, 3)
    finite_array(f"{name}.direction_body", beam.direction_body, 3)
    length = math.hypot(*beam.direction_body)
    if abs(length - 1.0) > UNIT_TOLERANCE:
        raise InvalidInputError(f"{name}.direction_body has length {length:g}; give a unit vector")


def _set_read_only(owner: object, name: str, values: FloatArray) -> None:
    """Set an array field of a frozen dataclass."""
    values.setflags(write=False)
    object.__setattr__(owner, name, values)
