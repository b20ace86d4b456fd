"""A simulation plays at its speed, pauses, steps, and hears the page while it waits."""

from __future__ import annotations

from itertools import pairwise

import pytest

from dq_marine.viewer.controls import Event, Group, Panel
from dq_marine.viewer.playback import FASTEST, PLAYING, SLOWEST, SPEED, STEP, Playback


class Wall:
    """A clock that only sleep moves; what is to happen at a time happens in `look`."""

    def __init__(self) -> None:
        self.now = 0.0
        self.looks = 0
        self.events: list[tuple[float, Event]] = []
        self.playback = Playback(clock=lambda: self.now, sleep=self.sleep)

    def sleep(self, seconds: float) -> None:
        assert 0.0 < seconds < 1.0
        self.now += seconds

    def look(self) -> None:
        self.looks += 1
        for time, event in list(self.events):
            if time <= self.now:
                self.events.remove((time, event))
                self.playback.take(event)

    def fly(self, periods: int, period: float) -> list[float]:
        """When each control period was let go, on the wall."""
        times = []
        for index in range(periods):
            self.playback.wait(index * period, self.look)
            times.append(self.now)
        return times


@pytest.fixture
def wall() -> Wall:
    return Wall()


@pytest.mark.parametrize("speed", [SLOWEST, 1.0, 2.0, FASTEST])
def test_time_goes_at_the_speed_that_is_asked_for(wall: Wall, speed: float) -> None:
    wall.playback.take(Event(SPEED, speed))
    times = wall.fly(21, 0.1)
    assert times[-1] - times[0] == pytest.approx(20 * 0.1 / speed, rel=1e-9)


def test_a_pause_lasts_until_play(wall: Wall) -> None:
    wall.events = [(0.25, Event(PLAYING, False)), (5.0, Event(PLAYING, True))]
    times = wall.fly(10, 0.1)
    longest = max(b - a for a, b in pairwise(times))
    assert longest == pytest.approx(5.0 - 0.25, abs=0.1)
    assert times[-1] - times[4] == pytest.approx(0.5, abs=1e-6)


def test_steps_go_one_by_one(wall: Wall) -> None:
    wall.playback.take(Event(PLAYING, False))
    wall.events = [(1.0, Event(STEP)), (2.0, Event(STEP)), (2.0, Event(STEP)), (9.0, Event(PLAYING, True))]
    times = wall.fly(4, 0.1)
    assert times == pytest.approx([1.0, 2.0, 2.0, 9.0], abs=0.03)


def test_a_long_period_is_interrupted_by_what_happens_in_the_page(wall: Wall) -> None:
    """A ship acts once a second or less: at a tenth of the speed nobody wants to wait that long."""
    wall.playback.take(Event(SPEED, SLOWEST))
    wall.events = [(1.0, Event(SPEED, FASTEST))]
    times = wall.fly(2, 1.0)
    assert times[1] == pytest.approx(1.0, abs=0.05)
    assert wall.looks > 20


def test_the_controls_show_how_it_stands(wall: Wall) -> None:
    wall.playback.take(Event(SPEED, 5.0))
    wall.playback.take(Event(PLAYING, False))
    wall.playback.take(Event("something else", 3))
    values = {
        control["name"]: control.get("value")
        for control in Panel([Group("a", wall.playback.controls())]).described()[0]["controls"]
    }
    assert values == {STEP: None, PLAYING: False, SPEED: 5.0}
