"""Each thing stands where the snapshot says, in NED, and the view follows the vehicle."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose
from viewer.samples import AUV, ROV, snapshot, yawed

from dq_marine.errors import InvalidInputError
from dq_marine.physics.waves.sea import Sea
from dq_marine.physics.waves.spectra import Jonswap
from dq_marine.viewer.models.vehicle_model import GOAL_BALL, GOAL_GHOST, VEHICLE
from dq_marine.viewer.placement import HIDDEN_SCALE, Placement
from dq_marine.viewer.snapshot import Shape, Snapshot, Thrust
from dq_marine.viewer.world.arrows import CURRENT_PATHS, NET_THRUST, thrust_path
from dq_marine.viewer.world.camera import LeashedView
from dq_marine.viewer.world.dials import ACTUATORS, CURRENT, FORCE, MOMENT, WAVES, WIND
from dq_marine.viewer.world.drawing import CLOCK, WORLD, Drawing, checked_floor_depth, floor_below
from dq_marine.viewer.world.sea import FLOOR, SHADOW, SPECKS, SURFACE, SeaScale
from dq_marine.viewer.world.trail import LONGEST, Trail


def place(shown: Snapshot, path: str, shape: Shape = ROV) -> Placement:
    """Where one thing stands in a fresh drawing."""
    return Drawing(shape).placements(shown)[path]


def tip(arrow: Placement) -> np.ndarray:
    """From the tail of a unit arrow along y to its tip, in the world."""
    return arrow.scale * arrow.rotation_matrix() @ [0.0, 1.0, 0.0]


def in_page(world: Placement, point_ned: list[float]) -> np.ndarray:
    """A point of the world in meshcat's own frame."""
    return world.rotation_matrix() @ point_ned + world.position


def test_world_is_ned_and_centred_at_the_vehicle() -> None:
    world = place(snapshot(position_ned=[10.0, 20.0, 5.0]), WORLD)
    assert_allclose(in_page(world, [10.0, 20.0, 5.0]), [0.0, 0.0, 0.0], atol=1e-12)
    assert_allclose(in_page(world, [11.0, 20.0, 5.0]), [1.0, 0.0, 0.0], atol=1e-12)
    assert_allclose(in_page(world, [10.0, 21.0, 5.0]), [0.0, -1.0, 0.0], atol=1e-12)
    assert_allclose(in_page(world, [10.0, 20.0, 6.0]), [0.0, 0.0, -1.0], atol=1e-12)


def test_vehicle_and_clock() -> None:
    shown = snapshot(time=12.5, position_ned=[1.0, 2.0, 3.0], quaternion_body_to_ned=yawed(0.3))
    vehicle = place(shown, VEHICLE)
    assert vehicle.position == (1.0, 2.0, 3.0)
    assert_allclose(vehicle.quaternion, yawed(0.3))
    assert place(shown, CLOCK).position[0] == 12.5


def test_thrust_arrow_points_where_the_force_pushes() -> None:
    ahead = snapshot(quaternion_body_to_ned=yawed(math.pi / 2), wrench_body=[40.0, 0, 0, 0, 0, 0])
    arrow = place(ahead, NET_THRUST)
    # Heading east, a force along body x pushes east; it starts at the bow, half a length ahead.
    assert_allclose(arrow.position, [0.0, ROV.length / 2, 5.0], atol=1e-12)
    direction = tip(arrow) / np.linalg.norm(tip(arrow))
    assert_allclose(direction, [0.0, 1.0, 0.0], atol=1e-12)


def test_thrust_arrow_is_proportional_up_to_full_force() -> None:
    lengths = [
        np.linalg.norm(tip(place(snapshot(wrench_body=[0.0, force, 0, 0, 0, 0]), NET_THRUST)))
        for force in (20.0, 40.0, 80.0, 800.0)
    ]
    assert lengths[1] == pytest.approx(2 * lengths[0])
    assert lengths[2] == pytest.approx(4 * lengths[0])
    assert lengths[3] == pytest.approx(lengths[2])


def test_no_force_no_arrow_but_in_place() -> None:
    arrow = place(snapshot(position_ned=[3.0, 4.0, 5.0]), NET_THRUST)
    assert arrow.scale == HIDDEN_SCALE
    assert arrow.position == (3.0, 4.0, 5.0)


def thrusting(*forces: list[float], **changes: Any) -> Snapshot:
    """Actuators at the corners of a square, each with a force in body axes."""
    places = ([0.2, 0.1, 0.0], [0.2, -0.1, 0.0], [-0.2, -0.1, 0.0], [-0.2, 0.1, 0.0])
    thrusts = tuple(
        Thrust(np.array(place), np.array(force)) for place, force in zip(places, forces, strict=False)
    )
    return snapshot(thrusts=thrusts, wrench_body=[*np.sum(forces, axis=0), 0, 0, 0], **changes)


def test_each_actuator_has_an_arrow_where_it_is_mounted_and_the_net_arrow_is_gone() -> None:
    shape = replace(ROV, max_thrust=20.0)
    shown = thrusting([10.0, 0.0, 0.0], [0.0, 0.0, -20.0], quaternion_body_to_ned=yawed(math.pi / 2))
    drawing = Drawing(shape)
    assert [message.path for message in drawing.appear(shown)] == [thrust_path(0), thrust_path(1)]
    assert drawing.appear(shown) == []
    places = drawing.placements(shown)
    # Heading east, forward is east and starboard is south.
    assert_allclose(places[thrust_path(0)].position, [-0.1, 0.2, 5.0], atol=1e-12)
    assert_allclose(places[thrust_path(1)].position, [0.1, 0.2, 5.0], atol=1e-12)
    full = 0.6 * ROV.length
    assert_allclose(tip(places[thrust_path(0)]), [0.0, full / 2, 0.0], atol=1e-12)
    assert_allclose(tip(places[thrust_path(1)]), [0.0, 0.0, -full], atol=1e-12)
    assert places[NET_THRUST].scale == HIDDEN_SCALE


def test_arrows_of_actuators_that_are_no_more_are_hidden() -> None:
    drawing = Drawing(ROV)
    drawing.appear(thrusting([40.0, 0.0, 0.0], [40.0, 0.0, 0.0]))
    one = thrusting([40.0, 0.0, 0.0])
    assert drawing.appear(one) == []
    scales = [drawing.placements(one)[thrust_path(number)].scale > HIDDEN_SCALE for number in (0, 1)]
    assert scales == [True, False]
    assert drawing.placements(snapshot(wrench_body=[40.0, 0, 0, 0, 0, 0]))[NET_THRUST].scale > HIDDEN_SCALE


def test_arrows_say_what_a_metre_of_them_means() -> None:
    """As many newtons, and metres per second, as their length stands for: the page's legend reads it."""
    drawing = Drawing(ROV)
    shown = thrusting([50.0, 0.0, 0.0], current_ned=[0.3, 0.0, 0.0])
    messages = {message.path: message for message in [*drawing.scenery(shown), *drawing.appear(shown)]}
    places = drawing.placements(shown) | {
        NET_THRUST: place(snapshot(wrench_body=[50.0, 0, 0, 0, 0, 0]), NET_THRUST)
    }
    for path, value in ((thrust_path(0), 50.0), (NET_THRUST, 50.0), (CURRENT_PATHS[0], 0.3)):
        per_metre = messages[path].content["object"]["object"]["userData"]["per_metre"]
        assert per_metre * places[path].scale == pytest.approx(value)


def test_dials_show_force_current_wind_and_waves() -> None:
    sea = Sea(Jonswap(2.0, 8.0), direction=math.pi / 2)
    shown = snapshot(
        quaternion_body_to_ned=yawed(math.pi / 2),
        wrench_body=[40.0, 0, 0, 5.0, 0, 7.0],
        current_ned=[0.1, 0.2, 0.3],
        wind_ned=[-8.0, 0.0, 0.0],
        sea=sea,
    )
    dials = (FORCE, MOMENT, ACTUATORS, CURRENT, WIND, WAVES)
    numbers = {path: list(place(shown, path).position) for path in dials}
    expected = ([0, 40, 0], [0, 5, 7], [0, 0, 0], [0.1, 0.2, 0.3], [-8, 0, 0], [0, 2, 8])
    assert_allclose(list(numbers.values()), expected, atol=1e-12)
    for path in (WIND, WAVES):
        assert place(snapshot(), path).position == (0.0, 0.0, 0.0)
    assert place(thrusting([1.0, 0.0, 0.0]), ACTUATORS).position[0] == 1.0


def test_current_arrows() -> None:
    still = Drawing(ROV).placements(snapshot())
    slow = Drawing(ROV).placements(snapshot(current_ned=[0.0, -0.2, 0.0]))
    fast = Drawing(ROV).placements(snapshot(current_ned=[0.0, -0.4, 0.0]))
    for path in CURRENT_PATHS:
        assert still[path].scale == HIDDEN_SCALE
        assert_allclose(tip(fast[path]), 2 * tip(slow[path]))
        assert_allclose(tip(slow[path])[[0, 2]], 0.0, atol=1e-12)
        assert tip(slow[path])[1] < 0.0


def test_goal_with_and_without_attitude() -> None:
    none, spot = snapshot(), snapshot(goal_position_ned=[1.0, 2.0, 3.0])
    pose = snapshot(goal_position_ned=[1.0, 2.0, 3.0], goal_quaternion_body_to_ned=yawed(1.0))
    scales = [(place(s, GOAL_GHOST).scale, place(s, GOAL_BALL).scale) for s in (none, spot, pose)]
    assert scales == [(HIDDEN_SCALE, HIDDEN_SCALE), (HIDDEN_SCALE, 1.0), (1.0, HIDDEN_SCALE)]
    assert place(spot, GOAL_BALL).position == place(pose, GOAL_GHOST).position == (1.0, 2.0, 3.0)
    assert_allclose(place(pose, GOAL_GHOST).quaternion, yawed(1.0))


def test_floor_lies_below_start_and_goal_and_keeps_below_the_vehicle() -> None:
    drawing = Drawing(ROV)
    first = drawing.placements(snapshot(goal_position_ned=[0.0, 0.0, 9.0]))[FLOOR].position[2]
    assert 9.0 + ROV.size < first < 9.0 + 10 * ROV.size
    assert drawing.placements(snapshot(position_ned=[0.0, 0.0, 6.0]))[FLOOR].position[2] == first
    deep = drawing.placements(snapshot(position_ned=[0.0, 0.0, 30.0]))[FLOOR].position[2]
    assert deep > 30.0
    drawing.restart()
    assert drawing.placements(snapshot())[FLOOR].position[2] < first


def test_given_floor_is_kept() -> None:
    deep = snapshot(position_ned=[0.0, 0.0, 50.0])
    placements = Drawing(ROV, floor_depth=12.0).placements(deep)
    assert placements[FLOOR].position[2] == 12.0
    assert placements[SHADOW].scale == HIDDEN_SCALE


def test_floor_below_a_whole_motion() -> None:
    dive = [snapshot(position_ned=[0.0, 0.0, depth]) for depth in (1.0, 40.0, 2.0)]
    assert floor_below(dive, ROV) > 40.0 + ROV.size


@pytest.mark.parametrize("depth", [0.0, -3.0, float("nan"), float("inf")])
def test_bad_floor_depth_is_refused(depth: float) -> None:
    with pytest.raises(InvalidInputError, match="floor_depth is"):
        checked_floor_depth(depth)


def test_sea_follows_a_far_vehicle_in_whole_periods() -> None:
    scale = SeaScale.of(AUV)
    placements = Drawing(AUV).placements(snapshot(position_ned=[1234.5, -987.6, 40.0]))
    for path, period in ((FLOOR, scale.period), (SURFACE, scale.period), (SPECKS, scale.speck_block)):
        offset = np.array(placements[path].position[:2])
        assert_allclose(offset / period, np.round(offset / period), atol=1e-9)
        assert np.abs(offset - [1234.5, -987.6]).max() <= period / 2


def test_grid_cells_have_round_sizes_no_smaller_than_the_vehicle() -> None:
    cells = {size: SeaScale.of(Shape(size, 0.1, 0.1)).cell for size in (0.457, 0.5, 1.33, 5.0, 83.0)}
    assert cells == {0.457: 0.5, 0.5: 0.5, 1.33: 2.0, 5.0: 5.0, 83.0: 100.0}


def test_view_stays_for_small_motions_and_follows_large_ones() -> None:
    view = LeashedView(1.0)
    start = view.follow(np.zeros(3))
    assert_allclose(view.follow(np.array([0.9, 0.0, 0.0])), start)
    assert_allclose(view.follow(np.array([3.0, 4.0, 0.0])), [2.4, 3.2, 0.0])
    view.restart()
    assert_allclose(view.follow(np.array([50.0, 0.0, 0.0])), [50.0, 0.0, 0.0])


def test_trail_forgets_the_oldest_and_skips_the_nearest() -> None:
    trail = Trail(spacing=0.1)
    taken = [trail.extend(np.array([0.06 * i, 0.0, 0.0]), 0.1 * i) for i in range(5)]
    assert taken == [True, False, True, False, True]
    for i in range(2 * LONGEST):
        trail.extend(np.array([float(i), 5.0, 0.0]), float(i))
    points = trail.message().content["object"]["geometries"][0]["data"]["attributes"]["position"]["array"]
    drawn = np.frombuffer(points.data, dtype="<f4").reshape(-1, 3)
    assert_allclose(drawn[:, 0], np.arange(LONGEST, 2 * LONGEST))
    times = trail.message().content["object"]["object"]["userData"]["times"]
    assert_allclose(np.frombuffer(times.data, dtype="<f4"), drawn[:, 0])
