"""Beams, fields of pillars and seabeds: against plain NumPy, and the laws that they keep."""

import math

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from scipy.optimize import brentq

from dq_marine.algebra.euler import quaternion_from_euler
from dq_marine.algebra.spatial import Spatial
from dq_marine.integrator.body import Motion
from dq_marine.task.world.beams import (
    FORWARD,
    SWATH,
    fan_across,
    fan_ahead,
    fan_bearings,
    fan_forward,
    ground_bearings,
    make_errors,
    make_fan,
    make_readings,
)
from dq_marine.task.world.keel import Keel, make_keel_over
from dq_marine.task.world.pillars import (
    LAYOUTS,
    FieldPlan,
    Hull,
    clearance,
    field_draws,
    footprint,
    make_drifted,
    make_field,
    make_nearest,
    pillars_cast,
)
from dq_marine.task.world.seabed import WAVE_DRAWS, make_seabed

ROWS, COLUMNS, BEAMS, SPACING, REACH = 3, 2, 16, 6.0, 20.0
COUNT = ROWS * COLUMNS
FIELD = make_field(ROWS, COLUMNS)
BEARINGS = fan_forward(BEAMS).bearings
FAN = make_fan(fan_forward(BEAMS), pillars_cast)
HULL = Hull(2.0, 0.5)
WAVES, STEEPEST = 4, 0.3
SEABED = make_seabed(WAVES)

angles = st.floats(-math.pi, math.pi)
seeds = st.integers(0, 10**6)


def uniforms(seed, count):
    return tuple(np.random.default_rng(seed).random(count).tolist())


def field(seed, course=0.3, speed=0.5, stands="pillars"):
    plan = FieldPlan(SPACING, speed, LAYOUTS[stands])
    return FIELD(course, plan, uniforms(seed, field_draws(ROWS, COLUMNS)), 0)


def ground(seed):
    return SEABED.drawn(30.0, STEEPEST, 40.0, uniforms(seed, WAVES * WAVE_DRAWS), 0)


def turned(pillars, angle):
    c, s = math.cos(angle), math.sin(angle)
    return tuple(p._replace(north=c * p.north - s * p.east, east=s * p.north + c * p.east) for p in pillars)


@given(seed=seeds, heading=angles, roll=st.floats(-0.3, 0.3), pitch=st.floats(-0.3, 0.3), angle=angles)
def test_beams_of_a_turned_vehicle_in_a_turned_world_read_the_same(seed, heading, roll, pitch, angle):
    pillars, origin = field(seed), (0.0, 0.0, 5.0)
    one = FAN(pillars, origin, quaternion_from_euler(roll, pitch, heading), REACH)
    both = FAN(turned(pillars, angle), origin, quaternion_from_euler(roll, pitch, heading + angle), REACH)
    differing = [abs(a - b) > 1e-6 for a, b in zip(one, both, strict=True)]
    assert sum(differing) <= 1  # a beam that grazes a pillar may meet or miss it


@given(seed=seeds, heading=angles)
def test_beams_end_where_marching_points_first_are_in_a_pillar(seed, heading):
    pillars = np.array(field(seed))
    along = np.arange(0.0, REACH, 2e-3)
    ranges = FAN(field(seed), (0.0, 0.0, 5.0), quaternion_from_euler(0.0, 0.0, heading), REACH)
    for bearing, found in zip(BEARINGS, ranges, strict=True):
        way = along[:, None] * [math.cos(heading + bearing), math.sin(heading + bearing)]
        inside = (np.linalg.norm(way[:, None] - pillars[:, :2], axis=2) < pillars[:, 2]).any(axis=1)
        if inside.any():
            assert found <= along[inside.argmax()] + 1e-9
        end = found * np.array([math.cos(heading + bearing), math.sin(heading + bearing)])
        nearest = (np.linalg.norm(end - pillars[:, :2], axis=1) - pillars[:, 2]).min()
        assert found == REACH or abs(nearest) < 1e-9


def test_a_fan_reaches_from_port_to_starboard_evenly():
    assert BEARINGS[0] == -BEARINGS[-1] == -0.5 * FORWARD
    assert np.allclose(np.diff(BEARINGS), FORWARD / (BEAMS - 1))


def test_errors_are_normal_and_lost_as_often_as_told_and_do_not_depend_on_each_other():
    draw, noise, dropout = make_errors(2), 0.3, 0.2
    errors = np.array([draw(noise, dropout, uniforms(seed, 2)) for seed in range(20_000)])
    lost = errors > 1e8
    assert np.allclose(lost.mean(axis=0), dropout, atol=0.01)
    assert lost.all(axis=1).mean() == pytest.approx(dropout**2, abs=0.007)
    kept = errors[:, 0][~lost[:, 0] & lost[:, 1]], errors[:, 0][~lost.any(axis=1)]
    for own in kept:  # whether or not the other reading is lost
        assert own.mean() == pytest.approx(0.0, abs=4.0 * noise / math.sqrt(len(own)))
        assert own.std() == pytest.approx(noise, rel=0.05)


@given(
    ranges=st.tuples(*[st.floats(0.0, REACH)] * 4),
    errors=st.tuples(*[st.floats(-REACH, REACH) | st.just(1e9)] * 4),
)
def test_readings_are_shares_of_the_reach(ranges, errors):
    told, met = make_readings(4)(ranges, errors, REACH), np.array(ranges) < REACH
    assert np.allclose(told, np.where(met, np.clip((np.array(ranges) + errors) / REACH, 0.0, 1.0), 1.0))


def test_a_beam_that_meets_nothing_reads_so_whatever_its_error():
    assert make_readings(2)((REACH, 0.5 * REACH), (-0.3, -0.3), REACH) == (1.0, 0.5 - 0.3 / REACH)


@given(seed=seeds, course=angles, stands=st.sampled_from(list(LAYOUTS)))
def test_pillars_and_cages_stand_in_their_rows_with_room_between_them(seed, course, stands):
    pillars, layout = turned(field(seed, course, stands=stands), -course), LAYOUTS[stands]
    for i, pillar in enumerate(pillars):
        row = SPACING * (1.0 + i // COLUMNS)
        assert abs(pillar.north - row) <= layout.off_row * SPACING + 1e-9
        assert layout.thinnest * SPACING <= pillar.radius <= layout.thickest * SPACING
        for other in pillars[:i]:
            room = math.hypot(pillar.north - other.north, pillar.east - other.east)
            assert room - pillar.radius - other.radius >= SPACING * (
                1.0 - 2.0 * max(layout.off_row, layout.off_place) - 2.0 * layout.thickest - 1e-9
            )


def test_every_other_pillar_drifts_at_its_velocity():
    pillars, after = field(1), make_drifted(COUNT)(field(1), 4.0)
    for i, (one, later) in enumerate(zip(pillars, after, strict=True)):
        speed = math.hypot(one.north_velocity, one.east_velocity)
        assert (0.0 < speed <= 0.5) if i % 2 else speed == 0.0
        gone = np.subtract(later[:2], one[:2])
        assert np.allclose(gone, 4.0 * np.array(one[3:]), atol=1e-12)
        assert later[2:] == one[2:]


@given(seed=seeds, heading=angles)
def test_clearance_is_that_of_the_nearest_point_of_the_hull(seed, heading):
    place = footprint((1.0, 2.0, 0.0), quaternion_from_euler(0.1, -0.2, heading))
    spine = np.linspace(-1.5, 1.5, 3001)[:, None] * [math.cos(heading), math.sin(heading)] + [1.0, 2.0]
    pillars = field(seed)
    own = [clearance(pillar, place, HULL) for pillar in pillars]
    for pillar, found in zip(pillars, own, strict=True):
        gap = np.linalg.norm(spine - pillar[:2], axis=1).min() - HULL.half_beam - pillar.radius
        assert found == pytest.approx(gap, abs=1e-3)
    nearest = make_nearest(COUNT)(pillars, place, HULL)
    assert nearest.clearance == min(own)
    assert nearest[1:] == pillars[own.index(min(own))][3:]


@given(seed=seeds, north=st.floats(-200.0, 200.0), east=st.floats(-200.0, 200.0))
def test_a_seabed_is_nowhere_steeper_than_told(seed, north, east):
    own, step = ground(seed), 1e-4
    slopes = [
        (SEABED.depth(own, north + a, east + b) - SEABED.depth(own, north - a, east - b)) / (2.0 * step)
        for a, b in ((step, 0.0), (0.0, step))
    ]
    assert math.hypot(*slopes) <= STEEPEST + 1e-6


@given(seed=seeds, heading=angles, tilt=st.floats(0.0, 1.0))
def test_a_beam_ends_at_the_seabed_where_brents_method_finds_it(seed, heading, tilt):
    own = ground(seed)
    direction = (
        math.sin(tilt) * math.cos(heading),
        math.sin(tilt) * math.sin(heading),
        math.cos(tilt),
    )

    def height(way):
        north, east, depth = (way * part for part in direction)
        return SEABED.depth(own, north, east) - 20.0 - depth

    met = brentq(height, 0.0, 100.0)
    found = SEABED.cast(own, (0.0, 0.0, 20.0), direction, 1e3)
    assert met * (1.0 - 1e-3) <= found <= met + 1e-9
    assert SEABED.cast(own, (0.0, 0.0, 20.0), direction, 2.0) == pytest.approx(min(found, 2.0))


@given(seed=seeds, heading=angles, below=st.floats(-0.2, 0.5))
@example(seed=95146, heading=1.0, below=0.09375)
def test_a_beam_that_grazes_the_seabed_stops_at_it_and_not_before(seed, heading, below):
    """Where the bound of the slope alone would creep: the first crossing is found on a fine grid, and refined."""
    own, reach = ground(seed), 60.0
    origin = (0.0, 0.0, SEABED.depth(own, 0.0, 0.0) - 5.0)
    direction = (
        math.cos(below) * math.cos(heading),
        math.cos(below) * math.sin(heading),
        math.sin(below),
    )

    def height(way):
        north, east, depth = (o + way * part for o, part in zip(origin, direction, strict=True))
        return SEABED.depth(own, north, east) - depth

    ways = np.linspace(0.0, reach, 1201)
    under = np.flatnonzero(np.array([height(way) for way in ways]) < 0.0)
    met = brentq(height, ways[under[0] - 1], ways[under[0]]) if under.size else reach
    found = SEABED.cast(own, origin, direction, reach)
    assert found <= met + 1e-9
    assert found >= met - 1e-3 * reach or height(found) < 0.05  # along a crest it may come near before


@given(seed=seeds, heading=angles, below=st.floats(-0.2, 1.5))
def test_a_beam_that_ends_its_march_early_is_where_all_steps_would_lead_it(seed, heading, below):
    level = math.cos(below)
    direction = (level * math.cos(heading), level * math.sin(heading), math.sin(below))
    beam = (ground(seed), (0.0, 0.0, SEABED.depth(ground(seed), 0.0, 0.0) - 5.0), direction, 60.0)
    found = SEABED.cast(*beam)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("dq_marine.task.world.seabed.every", lambda condition: False)
        assert SEABED.cast(*beam) == found


@given(seed=seeds, north=st.floats(-200.0, 200.0), east=st.floats(-200.0, 200.0), course=angles)
def test_growth_along_a_course_is_that_of_the_depth(seed, north, east, course):
    own, step = ground(seed), 1e-3
    way = (math.cos(course), math.sin(course))
    depth, growth = SEABED.along(own, north, east, *way)
    ahead, astern = (SEABED.along(own, north + s * way[0], east + s * way[1], *way) for s in (step, -step))
    assert depth == SEABED.depth(own, north, east)
    assert growth == pytest.approx((ahead[0] - astern[0]) / (2.0 * step), abs=1e-6)


@pytest.mark.parametrize(("fan", "middle", "last"), [(fan_ahead(7), 6, 6), (fan_across(7), 3, None)])
def test_fans_that_see_the_ground_have_an_altimeter_in_the_plane_they_say(fan, middle, last):
    """Over level ground a beam reads the height over the sine of its angle below the horizon."""
    level = SEABED.drawn(30.0, 0.0, 40.0, uniforms(1, WAVES * WAVE_DRAWS), 0)
    ranges = make_fan(fan, SEABED.cast)(level, (3.0, 4.0, 20.0), quaternion_from_euler(0.0, 0.0, 1.2), 1e3)
    bearings = fan_bearings(7, SWATH) if last is None else ground_bearings(7)
    sines = [math.cos(b) if last is None else math.sin(b) for b in bearings]
    assert ranges == pytest.approx([10.0 / sine for sine in sines])
    assert ranges[middle] == pytest.approx(10.0)
    pitched = make_fan(fan, SEABED.cast)(level, (3.0, 4.0, 20.0), quaternion_from_euler(0.0, 0.2, 1.2), 1e3)
    assert pitched[middle] == pytest.approx(10.0 / math.cos(0.2))
    if last is None:  # the fan across the way pitches as a whole
        assert pitched == pytest.approx([one / math.cos(0.2) for one in ranges])
    else:  # that ahead turns in its plane: bow up, each beam looks farther ahead
        assert pitched == pytest.approx([10.0 / math.sin(b - 0.2) for b in bearings])


@given(seed=seeds, heading=angles, pitch=st.floats(-0.5, 0.5), depth=st.floats(20.0, 29.0))
def test_the_keel_clears_the_ground_by_its_lowest_point_and_strikes_at_the_speed_over_ground(
    seed, heading, pitch, depth
):
    own, keel = ground(seed), Keel(2.0, 0.5)
    attitude = quaternion_from_euler(0.0, pitch, heading)
    motion = Motion((1.0, 2.0, depth), attitude, Spatial((0.0, 0.0, 0.0), (3.0, 0.0, 4.0)))
    over = make_keel_over(SEABED.depth)(own, motion, keel)
    places = [(1.0, 2.0, depth)] + [
        (
            1.0 + s * math.cos(pitch) * math.cos(heading),
            2.0 + s * math.cos(pitch) * math.sin(heading),
            depth - s * math.sin(pitch),
        )
        for s in (2.0, -2.0)
    ]
    heights = [SEABED.depth(own, north, east) - down for north, east, down in places]
    assert over.altitude == pytest.approx(heights[0])
    assert over.clearance == pytest.approx(min(heights) - 0.5)
    assert over.impact_speed == (5.0 if over.clearance < 0.0 else 0.0)
