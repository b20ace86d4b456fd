"""Parts of observations that several tasks share."""

from __future__ import annotations

from collections.abc import Callable

from dq_marine.envs.core.definition import Observed
from dq_marine.task.acoustics import SENDERS, UNHEARD
from dq_marine.task.common import SPEED_BOUND
from dq_marine.task.lookout import VESSEL_SPEED_BOUND
from dq_marine.task.ranging import Schedule
from dq_marine.task.running_fix import FIXES
from dq_marine.task.sensors.observing import OLDEST

VELOCITY = (
    Observed("linear_velocity_body", "m/s", 3, SPEED_BOUND, "surge, sway and heave over ground"),
    Observed("angular_velocity_body", "rad/s", 3, SPEED_BOUND, "roll, pitch and yaw rate"),
)
"""What `dq_marine.task.common.observed_velocity` gives."""

GOAL_MOTION = (
    Observed("goal_velocity_body", "m/s", 3, SPEED_BOUND, "how fast the goal goes, over ground"),
    Observed("goal_turn_rate_body", "rad/s", 3, SPEED_BOUND, "how fast its course turns"),
    Observed("goal_acceleration_body", "m/s^2", 3, SPEED_BOUND, "its acceleration"),
)
"""What `dq_marine.task.common.observed_curve_motion` gives."""


RANGE_AGES = "range_ages"
"""Name of the part that `ages_shown` returns."""


def ages_shown(schedule: Schedule) -> Observed:
    """Return what is told besides of a range sensor that does not always tell at once."""
    whose = "of the readings" if schedule.turns == 1 else "of the readings, of a beam each"
    if 1 < schedule.turns < schedule.beams:
        whose = f"of the readings, of {schedule.beams // schedule.turns} beams each"
    return Observed(RANGE_AGES, "s", schedule.turns, OLDEST, f"time since the pings {whose}")


def numbered(kind: str, count: int, shown: Callable[[int], tuple[Observed, ...]]) -> tuple[Observed, ...]:
    """Return what is shown of several things of a kind, by names such as vessel_2_distance.

    Args:
        kind: what each is, such as "vessel".
        count: of them; they are numbered from 1 on.
        shown: number -> what is shown of that one, in whose names kind and number are still lacking.
    """
    return tuple(one._replace(name=f"{kind}_{k}_{one.name}") for k in range(1, count + 1) for one in shown(k))


def vessels_shown(count: int, far: float, longest: float) -> tuple[Observed, ...]:
    """Return what `dq_marine.task.lookout.shown` gives of so many vessels, within its bounds [m, s]."""
    level = "ahead and to starboard"
    passing = "how far off it passes, or has; less than 0 where its bearing turns to port"
    return numbered(
        "vessel",
        count,
        lambda k: (
            Observed("position_level", "m", 2, far, f"where vessel {k} is, {level}"),
            Observed("distance", "m", 1, far, "how far that is"),
            Observed("bearing_level", "", 2, 1.0, f"its bearing, {level}"),
            Observed("velocity_level", "m/s", 2, VESSEL_SPEED_BOUND, "its velocity less one's own"),
            Observed("course_level", "", 2, 1.0, f"its course, {level}"),
            Observed("passing_distance", "m", 1, far, passing),
            Observed("passing_time", "s", 1, longest, "until then; less than 0 once it is past"),
            Observed("rules", "", 3, 1.0, "1 or 0: there at all; to give way to; to leave to port"),
        ),
    )


def packets_shown(far: float, senders: int = SENDERS) -> tuple[Observed, ...]:
    """Return what `dq_marine.task.acoustics.packets_told` gives of so many; places are bounded by `far` [m]."""
    level = "ahead and to starboard"
    place = f"where it says it was, {level}, by both navigations"
    return numbered(
        "packet",
        senders,
        lambda k: (
            Observed("told", "", 3, 1.0, f"1 or 0: {k} has been heard; tells its course; its place"),
            Observed("age", "s", 1, UNHEARD, "time since it was sent"),
            Observed("range", "m", 1, far, "range, to where the sender was then"),
            Observed("position_level", "m", 2, far, place),
            Observed("deeper", "m", 1, far, "how much deeper it says it was"),
            Observed("course_level", "", 2, 1.0, f"its course, {level}"),
            Observed("speed", "m/s", 1, SPEED_BOUND, "its speed"),
        ),
    )


def fixes_shown(far: float) -> tuple[Observed, ...]:
    """Return what `dq_marine.task.running_fix.fix_told` gives of both fixes; distances are bounded by `far` [m]."""
    which = ("the likelier", "the other")
    return numbered(
        "fix",
        FIXES,
        lambda k: (
            Observed(
                "told", "", 1, 1.0, f"1 or 0: there is a running fix, by which {which[k - 1]} place is known"
            ),
            Observed("bearing_level", "", 2, 1.0, "where that is, as a unit vector, ahead and to starboard"),
            Observed("distance", "m", 1, far, "how far off it is, seen from above"),
            Observed("share", "", 1, 1.0, "how likely it is there, and not at the other"),
        ),
    )
