"""The pacer waits as long as it should, and forgives a slow simulation."""

from __future__ import annotations

import pytest

from dq_marine.errors import InvalidInputError
from dq_marine.viewer import RealTimePacer


class WallClock:
    """A clock that only goes on when somebody sleeps or works."""

    def __init__(self) -> None:
        self.now = 100.0
        self.slept: list[float] = []

    def sleep(self, seconds: float) -> None:
        self.slept.append(seconds)
        self.now += seconds


def pacer_on(clock: WallClock, speed: float = 1.0) -> RealTimePacer:
    return RealTimePacer(speed, clock=lambda: clock.now, sleep=clock.sleep)


@pytest.mark.parametrize(("speed", "wall_seconds"), [(1.0, 2.0), (4.0, 0.5), (0.5, 4.0)])
def test_simulated_time_keeps_pace(speed: float, wall_seconds: float) -> None:
    clock = WallClock()
    pacer = pacer_on(clock, speed)
    for step in range(201):
        pacer.wait_until(7.0 + 0.01 * step)
        clock.now += 0.001
    assert clock.now - 100.0 == pytest.approx(wall_seconds, abs=0.002)


def test_a_delay_is_forgiven_not_caught_up() -> None:
    clock = WallClock()
    pacer = pacer_on(clock)
    pacer.wait_until(0.0)
    clock.now += 5.0
    pacer.wait_until(0.1)
    clock.slept.clear()
    pacer.wait_until(0.2)
    assert clock.slept == pytest.approx([0.1])


def test_a_small_delay_is_caught_up() -> None:
    clock = WallClock()
    pacer = pacer_on(clock)
    pacer.wait_until(0.0)
    clock.now += 0.15
    pacer.wait_until(0.1)
    pacer.wait_until(0.3)
    assert clock.now == pytest.approx(100.3)


def test_a_new_episode_starts_the_count_anew() -> None:
    clock = WallClock()
    pacer = pacer_on(clock)
    pacer.wait_until(50.0)
    pacer.wait_until(0.0)
    assert clock.slept == []
    pacer.wait_until(0.5)
    assert clock.slept == pytest.approx([0.5])


@pytest.mark.parametrize("speed", [0.0, -1.0, float("nan"), float("inf")])
def test_bad_speed_is_refused(speed: float) -> None:
    with pytest.raises(InvalidInputError, match="speed is"):
        RealTimePacer(speed)
