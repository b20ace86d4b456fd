"""Parts of observations that several tasks share."""

from __future__ import annotations

from dq_marine.envs.core.definition import Observed
from dq_marine.task.acoustics import SENDERS, UNHEARD
from dq_marine.task.common import SPEED_BOUND
from dq_marine.task.lookout import VESSEL_SPEED_BOUND
from dq_marine.task.position_circles import CIRCLES
from dq_marine.task.ranging import Schedule
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


def vessels_shown(count: int, far: float, longest: float) -> tuple[Observed, ...]:
    """Return what `dq_marine.task.lookout.shown` gives of so many vessels, within its bounds [m, s]."""
    level = "ahead and to starboard"
    of_each = [
        (
            Observed(f"vessel_{k}_position_level", "m", 2, far, f"where vessel {k} is, {level}"),
            Observed(f"vessel_{k}_distance", "m", 1, far, "how far that is"),
            Observed(f"vessel_{k}_bearing_level", "", 2, 1.0, f"its bearing, {level}"),
            Observed(
                f"vessel_{k}_velocity_level", "m/s", 2, VESSEL_SPEED_BOUND, "its velocity less one's own"
            ),
            Observed(f"vessel_{k}_course_level", "", 2, 1.0, f"its course, {level}"),
            Observed(
                f"vessel_{k}_passing_distance",
                "m",
                1,
                far,
                "how far off it passes, or has; less than 0 where its bearing turns to port",
            ),
            Observed(f"vessel_{k}_passing_time", "s", 1, longest, "until then; less than 0 once it is past"),
            Observed(
                f"vessel_{k}_rules", "", 3, 1.0, "1 or 0: there at all; to give way to; to leave to port"
            ),
        )
        for k in range(1, count + 1)
    ]
    return tuple(one for parts in of_each for one in parts)


def packets_shown(far: float, senders: int = SENDERS) -> tuple[Observed, ...]:
    """Return what `dq_marine.task.acoustics.packets_told` gives of so many; places are bounded by `far` [m]."""
    level = "ahead and to starboard"
    of_each = [
        (
            Observed(
                f"packet_{k}_told", "", 3, 1.0, f"1 or 0: {k} has been heard; tells its course; its place"
            ),
            Observed(f"packet_{k}_age", "s", 1, UNHEARD, "time since it was sent"),
            Observed(f"packet_{k}_range", "m", 1, far, "range, to where the sender was then"),
            Observed(
                f"packet_{k}_position_level",
                "m",
                2,
                far,
                f"where it says it was, {level}, by both navigations",
            ),
            Observed(f"packet_{k}_deeper", "m", 1, far, "how much deeper it says it was"),
            Observed(f"packet_{k}_course_level", "", 2, 1.0, f"its course, {level}"),
            Observed(f"packet_{k}_speed", "m/s", 1, SPEED_BOUND, "its speed"),
        )
        for k in range(1, senders + 1)
    ]
    return tuple(one for parts in of_each for one in parts)


def circles_shown(far: float) -> tuple[Observed, ...]:
    """Return what `dq_marine.task.position_circles.circles_told` gives; places are bounded by `far` [m]."""
    of_each = [
        (
            Observed(
                f"circle_{k}_told", "", 1, 1.0, f"1 or 0: there is a circle {k} of position, 1 the newest"
            ),
            Observed(f"circle_{k}_centre_level", "m", 2, far, "its centre, ahead and to starboard"),
            Observed(f"circle_{k}_radius", "m", 1, far, "its radius"),
            Observed(f"circle_{k}_age", "s", 1, UNHEARD, "time since its range was measured"),
        )
        for k in range(1, CIRCLES + 1)
    ]
    return tuple(one for parts in of_each for one in parts)
