"""Pictures of manoeuvres say what a run has shown and no more; series made by hand, so that nothing is compiled."""

import math

import numpy as np
import pytest

from dq_marine.manoeuvres import acceleration_view, turning_circle_view
from dq_marine.manoeuvres.acceleration import Acceleration
from dq_marine.manoeuvres.series import Series
from dq_marine.manoeuvres.table import result_table
from dq_marine.manoeuvres.turning_circle import TurningCircle, steady_turn

RATE = 0.05


def turning(growth, drift=0.1):
    """A turn to starboard by 500 degrees at a radius that grows by a share of itself in each second."""
    time = np.linspace(0.0, math.radians(500.0) / RATE, 801)
    heading, course = RATE * time, RATE * time - drift
    speed = 1.0 + growth * time
    velocity_ned = speed * np.array([np.cos(course), np.sin(course)])
    steps = 0.5 * (velocity_ned[:, 1:] + velocity_ned[:, :-1]) * np.diff(time)
    north, east = np.hstack([np.zeros((2, 1)), np.cumsum(steps, axis=1)])
    none = np.zeros_like(time)
    u, v = speed * math.cos(drift), -speed * math.sin(drift)
    return Series(
        time=time,
        position_ned=np.column_stack([north, east, none]),
        quaternion_body_to_ned=np.column_stack([np.cos(heading / 2), none, none, np.sin(heading / 2)]),
        velocity_body=np.column_stack([u, np.broadcast_to(v, time.shape), none, none, none, none + RATE]),
        throttle=none + 1.0,
        helm=none + 1.0,
    )


def circle(series, *, settled):
    return TurningCircle(
        vehicle="a hull",
        length=2.0,
        width=0.5,
        settings={"helm": 1.0, "side": "starboard"},
        step=0.1,
        series=series,
        side="starboard",
        approach_speed=1.0,
        advance=None,
        transfer=None,
        tactical_diameter=None,
        time_90=None,
        time_180=None,
        time_360=None,
        largest_roll=0.0,
        steady=steady_turn(series, 1.0, settled=settled),
        course_growth_rate=0.0,
    )


def texts(figure):
    return " ".join(text.get_text() for axes in figure.axes for text in axes.texts).replace("\n", " ")


def labels(result):
    return " ".join(quantity.label for quantity in result.quantities())


def test_a_steady_turn_has_a_steady_radius():
    result = circle(turning(0.0), settled=True)
    figure = turning_circle_view.draw(result)
    assert f"steady radius {1.0 / RATE:.0f}" in texts(figure)
    assert [line.get_linestyle() for line in figure.axes[0].lines].count("--") == 1
    assert "steady radius" in labels(result)


def test_a_turn_that_did_not_become_steady_has_none():
    result = circle(turning(0.02), settled=False)
    figure = turning_circle_view.draw(result)
    assert "steady radius" not in texts(figure)
    assert "not steady: radius at the end" in texts(figure)
    assert "--" not in [line.get_linestyle() for line in figure.axes[0].lines]
    assert "steady" not in labels(result)
    assert "radius in the last half circle" in labels(result)
    assert result_table(result).row_count == len(result.quantities())


def test_a_drift_angle_astern_is_not_drawn_across_the_picture():
    """Bow and course are opposite, give or take: the angle goes from one end of its range to the other."""
    series = turning(0.0, drift=math.pi)
    wobble = 0.02 * np.sin(0.3 * series.time)
    swayed = series.velocity_body.copy()
    swayed[:, 1] += wobble
    result = circle(Series(**{**vars(turning(0.0, drift=math.pi)), "velocity_body": swayed}), settled=True)
    assert np.abs(np.diff(result.series.drift_angle)).max() > math.pi
    panels = turning_circle_view.draw(result).axes
    (drift,) = (line for axes in panels for line in axes.lines if str(line.get_label()).startswith("drift"))
    assert np.nanmax(np.abs(np.diff(drift.get_ydata()))) < 10.0


@pytest.mark.parametrize("settled", [True, False])
def test_a_speed_that_still_changed_is_not_the_top_speed(settled):
    series = turning(0.02)
    result = Acceleration(
        vehicle="a hull",
        length=2.0,
        width=0.5,
        settings={"throttle": 1.0},
        step=0.1,
        series=series,
        top_speed=1.0,
        settled=settled,
        time_63=None,
        time_90=None,
        distance_90=None,
    )
    shown = texts(acceleration_view.draw(result))
    assert ("top speed" in shown) is settled
    assert ("speed at the end, not steady" in shown) is not settled
    assert ("top speed" in labels(result)) is settled
