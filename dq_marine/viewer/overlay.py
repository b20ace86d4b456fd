"""Several recorded flights in one scene of one HTML file, on one time axis, each in a colour of its own, with plots.

The camera follows the first flight until another is chosen. Its vehicle stands where that of any replay does, the
others' under `/world/flights/...`; sea, things around and a common goal are drawn once (`shared_scene.py`). Thrust has
no arrows.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from dq_marine.errors import InvalidInputError
from dq_marine.viewer.clips import animation, moving_clips
from dq_marine.viewer.models.paint import FLIGHT_COLORS
from dq_marine.viewer.models.vehicle_model import VEHICLE, draw_goal, draw_vehicle
from dq_marine.viewer.placement import Placement, quaternion_wxyz, vector3
from dq_marine.viewer.replay import Replay, checked_target, checked_times, filled, script_json, staged
from dq_marine.viewer.shared_scene import SAME, Flight, check_number, check_one_scene, same_goal, stage_of
from dq_marine.viewer.snapshot import FloatArray, Snapshot
from dq_marine.viewer.transport.messages import Message, set_property, set_transform
from dq_marine.viewer.transport.pages import OVERLAY_PAGE
from dq_marine.viewer.transport.three_json import Json
from dq_marine.viewer.world.arrows import THRUST
from dq_marine.viewer.world.drawing import Drawing, checked_floor_depth, floor_below, goal_placements
from dq_marine.viewer.world.sea import SHADOW
from dq_marine.viewer.world.trail import TRAIL, draw_trail
from dq_marine.viewer.world.wake import WAKE

FLIGHTS = "/world/flights"

LOGARITHMIC = 1e3
"""Largest over smallest value of a plot from which on its axis is logarithmic, if all are above 0."""

LONGEST_AXIS = 1e9
"""Largest over smallest value of a logarithmic axis; what is below is drawn at its end."""


def save_overlay(
    path: str | os.PathLike[str],
    flights: Sequence[Flight],
    *,
    floor_depth: float | None = None,
    title: str = "dq-marine",
) -> None:
    """Write flights as one page: open it in any browser, play, pause, drag the slider, show and hide flights.

    The file appears complete or not at all; an older one of the same name is replaced.

    Args:
        path: of the HTML file; its folder must exist.
        flights: see `make_overlay` for these and the others.
        floor_depth: depth of the sea floor [m].
        title: above the clock.

    Raises:
        InvalidInputError: see `make_overlay`; or the path cannot be written.
        MissingDependencyError: meshcat is not installed.
    """
    target = checked_target(Path(path))
    make_overlay(flights, floor_depth=floor_depth, title=title).save(target)


def make_overlay(
    flights: Sequence[Flight], *, floor_depth: float | None = None, title: str = "dq-marine"
) -> Replay:
    """Return flights as one page. They begin at the same time and may end at different ones.

    Args:
        flights: one or more; the camera follows the first, until another is chosen in the page.
        floor_depth: depth of the sea floor [m]; None puts one below everything in the replay.
        title: plain text, shown above the clock.

    Raises:
        InvalidInputError: no flights, or more than there are colours; a name that is empty or there twice; times that
            do not increase; plots of another length; a `floor_depth` not above 0; or flights that cannot be shown in
            one scene, see `check_one_scene`.
        MissingDependencyError: meshcat is not installed.
    """
    _check(flights)
    first, *others = flights
    stage = stage_of(flights)
    times = np.array([snapshot.time for snapshot in stage])
    largest = max((flight.shape for flight in flights), key=lambda shape: shape.size)
    if floor_depth is None:
        floor_depth = max(floor_below(flight.snapshots, largest) for flight in flights)
    tint, *tints = FLIGHT_COLORS[: len(flights)]
    drawing = Drawing(first.shape, checked_floor_depth(floor_depth), tint=tint, largest=largest)
    messages, clips = staged(stage, times, drawing, tint)
    messages.append(set_property(THRUST, "visible", False))  # the legend leaves it out, too
    for number, (other, color) in enumerate(zip(others, tints, strict=True), start=1):
        drawn, moving = _beside(other, f"{FLIGHTS}/{number}", color, float(times[-1]), first)
        messages += drawn
        clips += moving
    return Replay(
        filled(
            OVERLAY_PAGE,
            title,
            messages + animation(clips),
            times=script_json(times.tolist()),
            overlay=script_json(_told(flights, float(times[0]), float(times[-1]))),
        )
    )


def _check(flights: Sequence[Flight]) -> None:
    check_number(len(flights))
    names = [flight.name for flight in flights]
    for flight in flights:
        if not flight.name.strip() or names.count(flight.name) > 1:
            raise InvalidInputError(
                f"the name {flight.name!r} is of {names.count(flight.name)} flight(s); give each a name of its own"
            )
        checked_times(flight.snapshots, f" of the flight {flight.name!r}")
        for label, values in flight.plots.items():
            if np.shape(values) != (len(flight.snapshots),):
                raise InvalidInputError(
                    f"the plot {label!r} of the flight {flight.name!r} has values of shape {np.shape(values)}; give "
                    f"one for each of its {len(flight.snapshots)} snapshots"
                )
    check_one_scene(flights)


def _beside(
    flight: Flight, path: str, color: int, end: float, first: Flight
) -> tuple[list[Message], list[Json]]:
    """Return what draws a flight that is not the first and places it, and its clips until the end of all [s].

    It has a goal of its own where that is not the first flight's.
    """
    vehicle, ghost, ball = f"{path}/vehicle", f"{path}/goal/ghost", f"{path}/goal/ball"
    own_goal = not same_goal(first, flight)

    def placed(snapshot: Snapshot) -> dict[str, Placement]:
        pose = Placement(vector3(snapshot.position_ned), quaternion_wxyz(snapshot.quaternion_body_to_ned))
        return {vehicle: pose, **(goal_placements(snapshot, ghost, ball) if own_goal else {})}

    frames = [placed(snapshot) for snapshot in flight.snapshots]
    times = np.array([snapshot.time for snapshot in flight.snapshots])
    track = np.array([snapshot.position_ned for snapshot in flight.snapshots])
    messages = [
        *draw_vehicle(flight.shape, vehicle, color),
        *(draw_goal(flight.shape, ghost, ball, color) if own_goal else []),
        draw_trail(track, times, path=f"{path}/trail", color=color),
        *(set_transform(place, placement) for place, placement in frames[0].items()),
    ]
    if end - times[-1] > SAME:  # it stands where it ended; a clip that is shorter would begin again
        frames, times = [*frames, frames[-1]], np.append(times, end)
    return messages, moving_clips(frames, times, frozenset({ghost, ball}))


def _told(flights: Sequence[Flight], begin: float, end: float) -> Json:
    """What the page's script is told: of each flight its name, colour, places in the scene, times and plots."""
    labels = list(dict.fromkeys(label for flight in flights for label in flight.plots))
    return {
        "begin": begin,
        "end": end,
        "flights": [
            {
                "name": flight.name,
                "caption": flight.caption,
                "color": f"#{color:06x}",
                "paths": [VEHICLE, TRAIL, WAKE, SHADOW] if number == 0 else [f"{FLIGHTS}/{number}"],
                "vehicle": VEHICLE if number == 0 else f"{FLIGHTS}/{number}/vehicle",
                "trail": TRAIL if number == 0 else f"{FLIGHTS}/{number}/trail",
                "times": [snapshot.time for snapshot in flight.snapshots],
                "plots": {label: _finite(values) for label, values in flight.plots.items()},
            }
            for number, (flight, color) in enumerate(zip(flights, FLIGHT_COLORS, strict=False))
        ],
        "charts": [chart for label in labels if (chart := _chart(label, flights))],
    }


def _finite(values: ArrayLike) -> list[float | None]:
    """Numbers as the page has them: None for what is not finite."""
    return [float(value) if np.isfinite(value) else None for value in np.asarray(values, dtype=float)]


def _chart(label: str, flights: Sequence[Flight]) -> dict[str, Any] | None:
    """The axis of a plot: what it is of, from where to where, and whether it is logarithmic; None without a number."""
    series = [np.asarray(flight.plots[label], dtype=float) for flight in flights if label in flight.plots]
    together: FloatArray = np.concatenate(series)
    known = together[np.isfinite(together)]
    if not known.size:
        return None
    low, high = float(known.min()), float(known.max())
    logarithmic = low > 0.0 and high > LOGARITHMIC * low
    if logarithmic:
        low = max(low, high / LONGEST_AXIS)
    if low == high:
        low, high = low - 0.5 * (abs(low) or 1.0), high + 0.5 * (abs(high) or 1.0)
    return {"label": label, "low": low, "high": high, "logarithmic": logarithmic}
