"""What sensors read, in plain Python: statistics of their errors at a fixed seed, rate and hold, drop-outs, limits."""

import math
from functools import partial

import numpy as np
import pytest
from support.bodies import random_quaternion

from dq_marine.algebra.normal import normal_pair
from dq_marine.algebra.quaternion import quaternion_conjugate, quaternion_multiply, rotate
from dq_marine.algebra.spatial import Spatial
from dq_marine.integrator.body import Motion
from dq_marine.task.sensors.build import (
    AHRS,
    DVL,
    GNSS,
    Accelerometer,
    DepthMeter,
    Gyroscope,
)
from dq_marine.task.sensors.errors import first_draws, later_draws, make_first_reading, make_later_reading

STILL = Motion((3.0, -2.0, 5.0), (1.0, 0.0, 0.0, 0.0), Spatial((0.0, 0.0, 0.0), (0.0, 0.0, 0.0)))
PERIOD = 0.1


def first_readings(sensor, motions, seed=0, period=PERIOD, gravity=9.81):
    random, numbers = np.random.default_rng(seed), sensor.numbers(period, gravity)
    read, draws = make_first_reading(sensor.instrument), first_draws(sensor.instrument)
    return [read(numbers, motion, tuple(random.random(draws).tolist())) for motion in motions]


def readings(sensor, motions, seed=0, period=PERIOD, gravity=9.81):
    """The first reading, and one after every further motion."""
    random, numbers = np.random.default_rng(seed), sensor.numbers(period, gravity)
    read, draws = make_later_reading(sensor.instrument), later_draws(sensor.instrument)
    taken = first_readings(sensor, motions[:1], seed + 1, period, gravity)
    for motion in motions[1:]:
        taken.append(read(numbers, taken[-1], motion, tuple(random.random(draws).tolist())))
    return taken


def values(taken):
    return np.array([reading.values for reading in taken])


def sinking(count):
    return [STILL._replace(position_ned=(3.0, -2.0, 0.01 * k)) for k in range(count)]


def test_normal_numbers_are_normal():
    scipy_stats = pytest.importorskip("scipy.stats")
    random = np.random.default_rng(0)
    pairs = np.array([normal_pair(*random.random(2).tolist()) for _ in range(20_000)])
    for column in pairs.T:
        assert scipy_stats.kstest(column, "norm").pvalue > 0.01
    assert abs(np.corrcoef(pairs.T)[0, 1]) < 0.02
    assert abs(np.corrcoef(pairs.T**2)[0, 1]) < 0.02
    assert all(math.isfinite(number) for number in normal_pair(1.0 - 2.0**-53, 0.5))


def test_a_perfect_sensor_tells_the_truth():
    rng = np.random.default_rng(1)
    for sensor, truth in (
        (Gyroscope(), lambda m: m.velocity.angular),
        (DVL(), lambda m: m.velocity.linear),
        (DepthMeter(), lambda m: m.position_ned[2:]),
        (GNSS(surface=10.0, rate=None), lambda m: m.position_ned[:2]),
        (AHRS(), lambda m: m.attitude),
    ):
        motions = [
            Motion(
                tuple(rng.normal(size=3).tolist()),
                tuple(random_quaternion(rng).tolist()),
                Spatial(tuple(rng.normal(size=3).tolist()), tuple(rng.normal(size=3).tolist())),
            )
            for _ in range(20)
        ]
        taken = readings(sensor, motions)
        assert [reading.values for reading in taken] == [truth(motion) for motion in motions]
        assert all(reading.age == 0.0 for reading in taken)


def test_noise_bias_and_scale_have_the_deviations_asked_for():
    moving = STILL._replace(velocity=Spatial((0.5, -1.0, 2.0), (0.0, 0.0, 0.0)))
    noise = values(readings(Gyroscope(noise=0.02), [moving] * 5000)) - moving.velocity.angular
    assert np.abs(noise.mean(axis=0)).max() < 4 * 0.02 / math.sqrt(5000)
    assert np.abs(noise.std(axis=0) / 0.02 - 1.0).max() < 0.04
    assert np.abs(np.corrcoef(noise.T) - np.eye(3)).max() < 0.06
    assert abs(np.corrcoef(noise[1:, 0], noise[:-1, 0])[0, 1]) < 0.06
    bias = values(first_readings(Gyroscope(bias=0.02), [STILL] * 5000))
    assert np.abs(bias.std(axis=0) / 0.02 - 1.0).max() < 0.04
    gains = values(first_readings(Gyroscope(scale=0.02), [moving] * 5000)) / moving.velocity.angular
    assert np.abs(gains.mean(axis=0) - 1.0).max() < 0.002
    assert np.abs(gains.std(axis=0) / 0.02 - 1.0).max() < 0.04
    held = readings(Gyroscope(bias=0.02, scale=0.02), [moving] * 20)
    assert len({reading.values for reading in held}) == 1, "bias and gain last for the episode"


@pytest.mark.parametrize("period", [0.05, 0.2])
def test_a_bias_walks_with_the_root_of_time(period):
    """Mean square of what it gains in t seconds: walk^2 t, whatever the control period (Allan's rate random walk)."""
    gained = values(readings(Gyroscope(walk=0.3), [STILL] * 20_000, period=period))
    assert not gained[0].any()
    for stride in (1, 4, 16):
        squares = ((gained[stride:] - gained[:-stride]) ** 2).mean()
        assert squares == pytest.approx(0.09 * stride * period, rel=0.1)


def test_a_slow_sensor_holds_its_reading_and_tells_its_age():
    taken = readings(DepthMeter(rate=2.5), sinking(41))
    expected = [4 * (k // 4) * 0.01 for k in range(41)]
    assert np.allclose(values(taken)[:, 0], expected, atol=1e-15)
    assert np.allclose([reading.age for reading in taken], [0.1 * (k % 4) for k in range(41)], atol=1e-12)


def test_a_rate_that_fits_no_whole_number_of_periods_is_met_on_average():
    taken = readings(DepthMeter(rate=3.0), sinking(1001))
    fresh = sum(reading.age == 0.0 for reading in taken[1:])
    assert fresh == 300


def test_a_fast_sensor_reads_once_in_a_period():
    assert all(reading.age == 0.0 for reading in readings(DepthMeter(rate=1000.0), sinking(500)))


def test_lost_readings_are_the_share_asked_for_and_leave_the_last_one():
    taken = readings(DepthMeter(dropout=0.3), sinking(10_000))
    lost = np.array([reading.age > 0.0 for reading in taken])
    assert lost.mean() == pytest.approx(0.3, abs=0.02)
    told = values(taken)[:, 0]
    assert np.array_equal(told[1:] == told[:-1], lost[1:])
    assert not any(reading.age == 0.0 for reading in readings(DepthMeter(dropout=1.0), sinking(50))[1:])


def test_a_dvl_needs_the_bottom_and_a_receiver_the_surface():
    log = readings(DVL(seabed=3.0, reach=1.0), sinking(400))
    assert [reading.age == 0.0 for reading in log[1:]] == [2.0 <= 0.01 * k < 3.0 for k in range(1, 400)]
    fix = readings(GNSS(rate=None, surface=0.505), sinking(100))
    assert [reading.age == 0.0 for reading in fix] == [k <= 50 for k in range(100)]


def test_ahrs_errors_turn_about_north_east_and_down():
    q = tuple(random_quaternion(np.random.default_rng(2)).tolist())
    turned = STILL._replace(attitude=q)
    told = [reading.values for reading in readings(AHRS(noise=0.05, tilt=0.2), [turned] * 4000)]
    errors = np.array([quaternion_multiply(one, quaternion_conjugate(q)) for one in told])
    assert np.allclose((errors**2).sum(axis=1), 1.0, atol=1e-14)
    assert np.abs(2.0 * errors[:, 1:].std(axis=0) / (0.01, 0.01, 0.05) - 1.0).max() < 0.05
    assert np.abs(errors[:, 1:].mean(axis=0)).max() < 0.002


@pytest.mark.parametrize("gravity", [9.81, 1.62])
def test_an_accelerometer_feels_the_opposite_of_gravity_and_every_change_of_velocity(gravity):
    rng = np.random.default_rng(3)
    q = tuple(random_quaternion(rng).tolist())
    spin = Spatial((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    acceleration = np.array([0.3, -0.2, 0.1])

    def at(k):
        body = rotate(quaternion_conjugate(q), tuple((acceleration * k * PERIOD).tolist()))
        return STILL._replace(attitude=q, velocity=spin._replace(linear=body))

    taken = readings(Accelerometer(), [at(k) for k in range(5)], gravity=gravity)
    felt = np.array([rotate(q, reading.values) for reading in taken])
    assert np.allclose(felt[0], (0.0, 0.0, -gravity), atol=1e-14)
    assert np.allclose(felt[1:], acceleration - (0.0, 0.0, gravity), atol=1e-13)


def test_what_is_measured_stands_in_the_motion_for_what_is_true():
    believe = partial(AHRS.instrument.believe, (0.0, 1.0, 0.0, 0.0))
    assert believe(STILL) == STILL._replace(attitude=(0.0, 1.0, 0.0, 0.0))
    assert GNSS.instrument.believe((7.0, 8.0), STILL).position_ned == (7.0, 8.0, 5.0)
    assert DepthMeter.instrument.believe((6.0,), STILL).position_ned == (3.0, -2.0, 6.0)
    assert DVL.instrument.believe((1.0, 2.0, 3.0), STILL).velocity.linear == (1.0, 2.0, 3.0)
    assert Gyroscope.instrument.believe((1.0, 2.0, 3.0), STILL).velocity.angular == (1.0, 2.0, 3.0)
    assert Accelerometer.instrument.believe((1.0, 2.0, 3.0), STILL) == STILL
