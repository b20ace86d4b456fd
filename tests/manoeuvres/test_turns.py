"""Turning circle, zig-zag and spiral: closed forms, mirror images, the helmsman's laws."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from setups import LIMITS, LINEAR, mass_of, sphere, spindle

from dq_marine.errors import InvalidInputError
from dq_marine.manoeuvres import spiral, turning_circle, zig_zag
from dq_marine.manoeuvres.approach import approached
from dq_marine.manoeuvres.conditions import Conditions
from dq_marine.manoeuvres.setup import prepared
from dq_marine.manoeuvres.spiral import SpiralPoint, loop
from dq_marine.manoeuvres.zig_zag import ZigZagHelmsman
from dq_marine.vehicles.analysis.munk import munk_growth_rate


def steady_turn_of(vehicle, helm):
    """r, u, v of a sphere: N = d_r r, X = d_u u - m r v, 0 = d_v v + m r u."""
    mass, damping, limits = mass_of(vehicle)[0], LINEAR, LIMITS
    r = helm * limits[5] / damping[5]
    u = limits[0] / (damping[0] + (mass * r) ** 2 / damping[1])
    return r, u, -mass * r * u / damping[1]


@pytest.mark.parametrize("helm", [1.0, 0.4])
def test_the_steady_turn_of_a_sphere(helm):
    vehicle = sphere()
    result = turning_circle(vehicle, helm=helm)
    r, u, v = steady_turn_of(vehicle, helm)
    assert not any("steady" in note for note in result.notes)
    assert result.steady.yaw_rate == pytest.approx(r, rel=1e-3)
    assert result.steady.speed == pytest.approx(math.hypot(u, v), rel=1e-3)
    assert result.steady.radius == pytest.approx(math.hypot(u, v) / r, rel=1e-3)
    assert result.steady.drift_angle == pytest.approx(math.atan2(-v, u), rel=1e-3)
    assert result.approach_speed == pytest.approx(LIMITS[0] / LINEAR[0], rel=1e-6)


def test_the_figures_are_places_of_the_track():
    result = turning_circle(sphere())
    series = result.series
    ahead, starboard = series.along_and_across().T
    for time, angle in ((result.time_90, 90.0), (result.time_180, 180.0), (result.time_360, 360.0)):
        assert np.interp(time, series.time, series.heading_change) == pytest.approx(
            math.radians(angle), rel=1e-9
        )
    assert np.interp(result.time_90, series.time, ahead) == result.advance
    assert np.interp(result.time_180, series.time, starboard) == result.tactical_diameter
    centre = np.array(result.steady.centre)
    radii = np.hypot(*(series.along_and_across()[-50:] - centre).T)
    assert radii == pytest.approx(result.steady.radius, rel=1e-2)


def assert_mirrored(one, other):
    assert np.abs(one.time - other.time).max() < 1e-9
    assert np.abs(one.along_and_across() - other.along_and_across() * [1.0, -1.0]).max() < 1e-9
    flip = np.array([1.0, -1.0, 1.0, -1.0, 1.0, -1.0])
    assert np.abs(one.velocity_body - other.velocity_body * flip).max() < 1e-9
    assert np.abs(one.helm + other.helm)[one.time >= 0.0].max() == 0.0


def test_port_is_the_mirror_image_of_starboard():
    """Of a circle and of a zig-zag, for a vehicle that is its own mirror image."""
    vehicle = spindle((40, 300, 300, 10, 300, 300))
    starboard, port = (turning_circle(vehicle, side=side) for side in ("starboard", "port"))
    assert_mirrored(starboard.series, port.series)
    for name in ("advance", "transfer", "tactical_diameter", "time_90"):
        assert getattr(starboard, name) == pytest.approx(getattr(port, name), rel=1e-9)
    assert starboard.steady.drift_angle == pytest.approx(port.steady.drift_angle, rel=1e-9)
    starboard, port = (zig_zag(vehicle, side=side) for side in ("starboard", "port"))
    assert_mirrored(starboard.series, port.series)
    assert [s.overshoot for s in starboard.swings] == pytest.approx(
        [s.overshoot for s in port.swings], rel=1e-9
    )


@given(
    headings=st.lists(st.floats(-1.5, 1.5), min_size=1, max_size=60),
    angle=st.floats(0.05, 1.0),
    helm=st.floats(0.05, 1.0),
    side=st.sampled_from([1.0, -1.0]),
)
def test_the_helm_is_reversed_just_when_the_heading_passes_the_angle(headings, angle, helm, side):
    helmsman = ZigZagHelmsman(angle, helm, side)
    before = side
    for count, heading in enumerate(headings):
        reversals = helmsman.reversals
        ordered = helmsman.order(heading)
        assert abs(ordered) == helm
        passed = before * heading >= angle
        assert (ordered * before < 0.0) == passed
        assert helmsman.reversals == reversals + passed
        assert helmsman.reversals <= count + 1
        before = math.copysign(1.0, ordered)


def test_the_zig_zag_of_a_sphere():
    """Yaw alone, I r' + d r = N, until the first reversal; each at the first sample beyond the angle."""
    vehicle = sphere()
    angle = math.radians(20.0)
    result = zig_zag(vehicle, angle=angle)
    inertia, damping, moment = mass_of(vehicle)[5], LINEAR[5], LIMITS[5] * 20.0 / 35.0
    series, constant = result.series, inertia / damping
    turned = moment / damping * (series.time - constant * (1.0 - np.exp(-series.time / constant)))
    first = (series.time >= 0.0) & (series.time <= result.initial_turning_time)
    assert np.abs(series.heading_change - turned)[first].max() < 1e-6
    changes = (
        np.flatnonzero(np.diff(series.helm[series.time >= 0.0])) + np.flatnonzero(series.time >= 0.0)[0] + 1
    )
    for sample, swing in zip(changes, result.swings, strict=False):
        assert series.time[sample] == swing.time
        assert (
            swing.side * series.heading_change[sample]
            >= angle
            > swing.side * series.heading_change[sample - 1]
        )
    assert len(result.swings) == 4
    assert all(swing.overshoot >= 0.0 for swing in result.swings)
    assert [swing.side for swing in result.swings] == [1.0, -1.0, 1.0, -1.0]
    assert result.period == pytest.approx(result.swings[3].time - result.swings[1].time)


def test_limits_of_the_standards():
    """MSC.137(76) for L/V between 10 and 30 s: (5 + L/V/2) and (17.5 + 0.75 L/V) degrees; 25 degrees in the 20/20."""
    quantities = {q.key: q for q in zig_zag(sphere(), overshoots=2).quantities()}
    assert quantities["overshoot_1_deg"].limit == pytest.approx(10.0)
    assert quantities["overshoot_2_deg"].limit == pytest.approx(25.0)
    twenty = {q.key: q for q in zig_zag(sphere(), angle=math.radians(20.0), overshoots=2).quantities()}
    assert twenty["overshoot_1_deg"].limit == 25.0
    assert twenty["overshoot_2_deg"].limit is None


@pytest.mark.parametrize("angle", [0.0, -0.1, 2.0, math.inf])
def test_wrong_angles_are_refused(angle):
    with pytest.raises(InvalidInputError, match="angle"):
        zig_zag(sphere(), angle=angle)


def test_wrong_helms_and_sides_are_refused():
    with pytest.raises(InvalidInputError, match=r"helm = 1.2 is above 1"):
        turning_circle(sphere(), helm=1.2)
    with pytest.raises(InvalidInputError, match="give 'starboard' or 'port'"):
        turning_circle(sphere(), side="left")


def test_the_spiral_of_a_sphere_has_no_loop():
    vehicle = sphere()
    result = spiral(vehicle, helms=2)
    assert (result.loop_width, result.loop_height) == pytest.approx((0.0, 0.0), abs=2e-3)
    for point in (*result.to_port, *result.to_starboard):
        assert point.settled
        assert point.yaw_rate == pytest.approx(point.helm * LIMITS[5] / LINEAR[5], abs=2e-3)
    assert [point.helm for point in result.to_port] == [1.0, 0.25, 0.0, -0.25, -1.0]


def test_the_spiral_of_an_unstable_vehicle_has_a_loop():
    result = spiral(spindle((40, 60, 300, 10, 300, 30)), helms=4)
    assert result.course_growth_rate > 0.0
    assert result.loop_width is None or result.loop_width > 0.01
    assert any("straight course" in note for note in result.notes)


def test_a_loop_is_as_wide_and_high_as_its_branches_are_apart():
    falling = [(1.0, 3.0), (0.0, 1.0), (-0.5, -1.0), (-1.0, -3.0)]
    rising = [(-1.0, -3.0), (0.0, -1.0), (0.5, 1.0), (1.0, 3.0)]
    points = [
        tuple(SpiralPoint(helm, rate, 1.0, True) for helm, rate in branch) for branch in (falling, rising)
    ]
    assert loop(*points) == pytest.approx((0.5, 2.0))
    assert loop(points[1][::-1], points[1]) == (0.0, 0.0)
    assert loop(points[0][:2], points[1]) == (None, None)


def test_growth_on_course_is_the_munk_instability_where_nothing_damps_it():
    vehicle = spindle((40, 0, 0, 0, 0, 0))
    start = approached(prepared(vehicle, Conditions()), "test")
    assert start.growth_rate == pytest.approx(munk_growth_rate(vehicle, start.speed), rel=1e-4)
    assert "Unstable on course" in start.notes[0]


def test_growth_on_course_of_a_sphere_is_that_of_its_slowest_damping():
    """No Munk moment: sway decays with d_v/m, yaw with d_r/I, roll stays: nothing rights it."""
    assert turning_circle(sphere()).course_growth_rate == 0.0
