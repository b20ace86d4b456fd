"""Beams that are drawn: their marks lie on what they meet, at what the agent was told; no bit of an episode changes."""

import gymnasium as gym
import numpy as np
import pytest
from support.sweeps import sweep

from dq_marine.backend.packing import unpack
from dq_marine.envs.tasks import obstacle_avoidance, pipeline_inspection, terrain_following
from dq_marine.task.grounds import make_wavy_ground
from dq_marine.viewer.placement import Placement, quaternion_wxyz

FAR = 20.0  # vehicle lengths: through most of the field
QUIET = {"noise": 0.0, "dropout": 0.0}
COUNTS = {
    "ObstacleAvoidance": obstacle_avoidance.sense_draws,
    "TerrainFollowing": terrain_following.BEAMS,
    "PipelineInspection": pipeline_inspection.BEAMS,
}
TOLERANCE = 1e-3  # m: rays are traced to less


def made(name, **keywords):
    return gym.make(f"dq_marine/{name}-v0", **keywords).unwrapped


def memory_of(env):
    return unpack(env.blank_memory, env.get_state()["memory"])


def ends_ned(snapshot):
    """Where the beams with an echo end in the world, shape (n, 3) [m]."""
    turn = Placement(quaternion=quaternion_wxyz(snapshot.quaternion_body_to_ned)).rotation_matrix()
    met = [beam for beam in snapshot.beams if beam.distance < beam.reach]
    ends_body = [np.array(beam.origin_body) + beam.distance * np.array(beam.direction_body) for beam in met]
    return snapshot.position_ned + np.array(ends_body) @ turn.T


def after_some_steps(env, steps=6):
    env.reset(seed=3)
    env.action_space.seed(3)
    for _ in range(steps):
        env.step(env.action_space.sample())
    return env.snapshot()


def test_marks_lie_on_pillars():
    env = made("ObstacleAvoidance", reach=FAR, **QUIET)
    ends = ends_ned(after_some_steps(env))
    assert len(ends) > 2
    pillars = memory_of(env).passage.pillars
    for north, east, _ in ends:
        nearest = min(np.hypot(north - one.north, east - one.east) - one.radius for one in pillars)
        assert nearest == pytest.approx(0.0, abs=TOLERANCE)


@pytest.mark.sweep
def test_marks_lie_on_the_seabed():
    env = made("TerrainFollowing", **QUIET)
    ends = ends_ned(after_some_steps(env))
    assert len(ends) > 2
    ground, depth_at = memory_of(env).ground, make_wavy_ground(terrain_following.WAVES).depth
    for north, east, down in ends:
        assert down == pytest.approx(depth_at(ground, north, east), abs=TOLERANCE)


@pytest.mark.parametrize(
    ("name", "count"),
    sweep(COUNTS.items(), plain=[("ObstacleAvoidance", COUNTS["ObstacleAvoidance"])]),
)
def test_what_is_drawn_is_what_the_agent_was_told(name, count):
    env = made(name, reach=FAR, noise=0.05, dropout=0.3)
    shown = after_some_steps(env)
    told = env.observation[:count]
    assert len(shown.beams) == count
    np.testing.assert_allclose([beam.distance / beam.reach for beam in shown.beams], told, rtol=1e-6)
    assert 1.0 in told  # a beam that met nothing, or was lost
    assert told.min() < 1.0


def test_a_snapshot_changes_no_bit_of_an_episode():
    plain, watched = made("ObstacleAvoidance"), made("ObstacleAvoidance")
    for env in (plain, watched):
        env.reset(seed=5)
        for _ in range(4):
            env.step(np.zeros(env.action_space.shape, np.float32))
            if env is watched:
                assert env.snapshot().beams == env.snapshot().beams
    assert np.array_equal(plain.observation, watched.observation)
    assert plain.get_state()["random"] == watched.get_state()["random"]


def test_without_range_sensors_there_are_none():
    env = made("StationKeeping")
    env.reset(seed=0)
    assert env.snapshot().beams == ()
