"""The whole picture: which things are drawn, and where each stands at a snapshot.

Everything hangs under `/world`, whose frame is NED:

| path | what |
|---|---|
| `/world/vehicle/...` | the vehicle, part by part |
| `/world/goal/ghost`, `/world/goal/ball` | the pose to reach; a ball where any attitude will do |
| `/world/thrust/...`, `/world/current/...` | arrows of the forces that are applied, and of the water's motion |
| `/world/trail` | past positions |
| `/world/beams` | the beams of range sensors, in body axes |
| `/world/floor/...`, `/world/surface`, `/world/specks`, `/world/shadow` | the sea |
| `/world/wake` | foam behind a vessel that floats |
| `/world/flights/...` | the other flights of an overlaid replay: vehicle, trail, goal (`viewer/overlay.py`) |
| `/world/things/...` | what is around the vehicle: pillars, vessels, docks, pipes |
| `/world/dials/...` | nothing to see: numbers for the page's legend (`world/dials.py`) |
| `/world/clock` | nothing to see: its x is the simulated time [s], which the page displays |
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from dq_marine.errors import InvalidInputError
from dq_marine.physics.waves.sea import Sea
from dq_marine.task.things import Relief
from dq_marine.viewer.models.vehicle_model import (
    GOAL_BALL,
    GOAL_GHOST,
    VEHICLE,
    draw_goal,
    draw_vehicle,
)
from dq_marine.viewer.placement import (
    Placement,
    Quaternion,
    hidden_at,
    quaternion_wxyz,
    vector3,
)
from dq_marine.viewer.snapshot import FloatArray, Shape, Snapshot
from dq_marine.viewer.transport.messages import Message
from dq_marine.viewer.world.arrows import Arrows
from dq_marine.viewer.world.beams import BEAMS
from dq_marine.viewer.world.camera import LEASH_IN_LENGTHS, LeashedView, place_camera
from dq_marine.viewer.world.dials import dial_placements
from dq_marine.viewer.world.sea import (
    FLOOR,
    SHADOW,
    SPECKS,
    SURFACE,
    SeaScale,
    draw_floor,
    draw_shadow,
    draw_specks,
    draw_surface,
    draw_waves,
    nearest_period,
)
from dq_marine.viewer.world.things import Things
from dq_marine.viewer.world.wake import draw_wake
from dq_marine.viewer.world.water import draw_water, surroundings_of

WORLD = "/world"
CLOCK = "/world/clock"

JUMPING_PATHS = frozenset({FLOOR, SURFACE, SPECKS, GOAL_GHOST, GOAL_BALL})
"""Things that may jump, by whole periods or to a new goal: they must not be seen on their way."""

CLEARANCE_IN_LENGTHS = 3.0
"""Water below the deepest point where no depth of the floor is given, in vehicle lengths."""

NED_TO_Z_UP: Quaternion = (0.0, 1.0, 0.0, 0.0)
"""Half a turn about x: meshcat's own frame has z up."""


class Drawing:
    """Turns snapshots into placements of the things in the scene."""

    def __init__(
        self,
        shape: Shape,
        floor_depth: float | None = None,
        *,
        tint: int | None = None,
        largest: Shape | None = None,
    ) -> None:
        """Draw nothing yet.

        Args:
            shape: the vehicle.
            floor_depth: depth of the sea floor [m], or None for one below vehicle and goal.
            tint: the vehicle is drawn in shades of it, 0xRRGGBB; None for its own colours.
            largest: of several vehicles in the scene, whose size camera and surroundings suit; None where it is alone.
        """
        self._shape = shape
        self._largest = shape if largest is None else largest
        self._tint = tint
        self._scale = SeaScale.of(self._largest)
        self._view = LeashedView(LEASH_IN_LENGTHS * self._largest.length)
        self._given_floor_depth = floor_depth
        self._floor_depth: float | None = None
        self._things = Things()
        self._arrows = Arrows(shape)
        self._has_beams = False
        self._sea: tuple[Sea | None, float] = (None, 0.0)

    def restart(self) -> list[Message]:
        """Forget the previous episode, and take away what was around the vehicle."""
        self._view.restart()
        self._floor_depth = None
        return self._things.forget()

    def scenery(self, first: Snapshot) -> list[Message]:
        """Everything there is to draw, before it is placed; sent once."""
        scale, surroundings = self._scale, surroundings_of(self._shape)
        return [
            *draw_water(surroundings, scale.sight),
            *draw_floor(scale, afloat=self._shape.floats),
            *draw_surface(scale, self._shape),
            *(draw_specks(scale) if surroundings.specks else ()),
            *draw_shadow(self._shape),
            *draw_wake(self._shape),
            *draw_vehicle(self._shape, tint=self._tint),
            *draw_goal(self._shape),
            *self._arrows.scenery(),
            *place_camera(first, self._largest, scale.sight),
        ]

    def appear(self, snapshot: Snapshot) -> list[Message]:
        """Draw what a snapshot has and has not been drawn; before its placements."""
        self._has_beams = self._has_beams or bool(snapshot.beams)
        return [
            *self._new_sea(snapshot),
            *self._things.appear(snapshot),
            *self._arrows.appear(snapshot),
        ]

    def _new_sea(self, snapshot: Snapshot) -> list[Message]:
        """Draw the surface, where the sea is not the one that has been drawn."""
        sea = (snapshot.sea, snapshot.sea_start)
        if sea == self._sea:
            return []
        self._sea = sea
        if snapshot.sea is None:
            return draw_surface(self._scale, self._shape)
        return draw_waves(self._scale, self._shape, snapshot.sea, snapshot.sea_start)

    def placements(self, snapshot: Snapshot) -> dict[str, Placement]:
        """Where everything that can move stands at a snapshot, by path."""
        position = snapshot.position_ned
        anchor = self._view.follow(position)
        north, east, down = vector3(anchor)
        pose = Placement(vector3(position), quaternion_wxyz(snapshot.quaternion_body_to_ned))
        body_to_ned = pose.rotation_matrix()
        return {
            CLOCK: Placement((snapshot.time, 0.0, 0.0)),  # first: by it the live page knows what may glide
            WORLD: Placement((-north, east, down), NED_TO_Z_UP),
            VEHICLE: pose,
            **self._beam_placements(snapshot, pose),
            **goal_placements(snapshot),
            **self._things.placements(snapshot),
            **self._arrows.placements(snapshot, body_to_ned),
            **dial_placements(snapshot, body_to_ned),
            **self._sea_placements(snapshot, anchor),
        }

    def _beam_placements(self, snapshot: Snapshot, pose: Placement) -> dict[str, Placement]:
        if not self._has_beams:
            return {}
        return {BEAMS: pose if snapshot.beams else hidden_at(pose.position)}

    def _sea_placements(self, snapshot: Snapshot, anchor: FloatArray) -> dict[str, Placement]:
        period, block = self._scale.period, self._scale.speck_block
        north, east = (nearest_period(float(value), period) for value in anchor[:2])
        specks_at = vector3([nearest_period(float(value), block) for value in anchor])
        floor_depth = self._floor_depth_at(snapshot)
        at_surface = (north, east, 0.0)
        x, y, z = vector3(snapshot.position_ned)
        if snapshot.sea is not None:  # its mesh is fine where the vehicle is
            at_surface = (x, y, 0.0)
        just_above_floor = (x, y, floor_depth - 0.02 * self._shape.height)
        return {
            FLOOR: Placement((north, east, floor_depth)),
            SURFACE: Placement(at_surface) if z < self._scale.sight else hidden_at(at_surface),
            SPECKS: Placement(specks_at),
            SHADOW: Placement(just_above_floor) if z < floor_depth else hidden_at(just_above_floor),
        }

    def _floor_depth_at(self, snapshot: Snapshot) -> float:
        """The depth asked for; or one some way below start and goal, deepened if need be."""
        if self._given_floor_depth is not None:
            return self._given_floor_depth
        if self._floor_depth is None:
            self._floor_depth = floor_below([snapshot], self._shape)
        deepest_keel = float(snapshot.position_ned[2]) + self._shape.length
        self._floor_depth = max(self._floor_depth, deepest_keel)
        return self._floor_depth


def floor_below(snapshots: Sequence[Snapshot], shape: Shape) -> float:
    """A depth for the sea floor [m], some way below everything the snapshots tell of."""
    places = [snapshot.position_ned for snapshot in snapshots]
    places += [s.goal_position_ned for s in snapshots if s.goal_position_ned is not None]
    deepest = max([*(float(place[2]) for place in places), *map(_bottom, snapshots)])
    return max(deepest, 0.0) + CLEARANCE_IN_LENGTHS * shape.size


def _bottom(snapshot: Snapshot) -> float:
    """The greatest depth of the seabeds in a snapshot [m], or 0."""
    depths = [
        thing.position_ned[2] + max(thing.form.depths)
        for thing in snapshot.things
        if isinstance(thing.form, Relief)
    ]
    return max(depths, default=0.0)


def checked_floor_depth(depth: float | None) -> float | None:
    """The depth of the sea floor [m] as given, if it is None or makes sense.

    Raises:
        InvalidInputError: it is not a finite number above 0.
    """
    if depth is not None and not (math.isfinite(depth) and depth > 0.0):
        raise InvalidInputError(
            f"floor_depth is {depth}; give a finite depth above 0 m, or None for one that suits"
        )
    return depth


def goal_placements(
    snapshot: Snapshot, ghost_path: str = GOAL_GHOST, ball_path: str = GOAL_BALL
) -> dict[str, Placement]:
    """Return where a goal's ghost and ball stand at a snapshot, by path."""
    position, attitude = snapshot.goal_position_ned, snapshot.goal_quaternion_body_to_ned
    nowhere = hidden_at(vector3(snapshot.position_ned))
    if position is None:
        return {ghost_path: nowhere, ball_path: nowhere}
    place = vector3(position)
    if attitude is None:
        return {ghost_path: nowhere, ball_path: Placement(place)}
    return {ghost_path: Placement(place, quaternion_wxyz(attitude)), ball_path: nowhere}
