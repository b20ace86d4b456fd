"""Playing, pausing and stepping a simulation, at a speed, as the person at its page wants."""

from __future__ import annotations

import time
from collections.abc import Callable

from dq_marine.viewer.controls import Button, Control, Event, Slider, Switch
from dq_marine.viewer.pacing import RealTimePacer

PLAYING, STEP, SPEED = "playing", "step", "speed"
"""Names of the controls."""

SLOWEST, FASTEST = 0.1, 20.0
"""Simulated seconds per second on the wall."""

PATIENCE = 0.02
"""Time between looks at what a person does, while the simulation is paused [s]."""


class Playback:
    """Holds a simulation up until it may go on.

    Attributes:
        playing: whether it goes on by itself.
    """

    def __init__(
        self, *, clock: Callable[[], float] = time.monotonic, sleep: Callable[[float], None] = time.sleep
    ) -> None:
        """Begin at real time.

        Args:
            clock: the time on the wall [s].
            sleep: waits for so many seconds.
        """
        self.playing = True
        self._speed, self._steps = 1.0, 0
        self._clock, self._sleep = clock, sleep
        self._look: Callable[[], None] = lambda: None
        self._pacer = self._new_pacer()

    def controls(self) -> tuple[Control, ...]:
        """Return the controls, as they stand."""
        return (
            Button(STEP, "Step", key="Period"),
            Switch(PLAYING, "play", self.playing, key="Space"),
            Slider(SPEED, "speed", SLOWEST, FASTEST, self._speed, 0.1, "x", logarithmic=True),
        )

    def take(self, event: Event) -> None:
        """Do what an event asks for, if it is of one of the controls."""
        if event.name == PLAYING:
            self.playing = event.value
        elif event.name == STEP:
            self.playing = False
            self._steps += 1
        elif event.name == SPEED:
            self._speed = event.value
        else:
            return
        self._pacer = self._new_pacer()

    def begin(self) -> None:
        """Start an episode: its time begins anew."""
        self._steps = 0
        self._pacer = self._new_pacer()

    def wait(self, sim_time: float, look: Callable[[], None]) -> None:
        """Return when the simulation may go on from a simulated time [s].

        Args:
            sim_time: that has been reached.
            look: called again and again; it hands the events of the page over by `take`, and may raise.
        """
        self._look = look
        look()
        if self.playing:
            self._pacer.wait_until(sim_time)
        while not (self.playing or self._steps):
            self._sleep(PATIENCE)
            look()
        self._steps = max(self._steps - 1, 0)

    def _new_pacer(self) -> RealTimePacer:
        return RealTimePacer(self._speed, clock=self._clock, sleep=self._doze)

    def _doze(self, seconds: float) -> None:
        """Sleep with an eye on the page; what changes the pace there ends it."""
        end, pacer = self._clock() + seconds, self._pacer
        while (left := end - self._clock()) > 0.0 and self._pacer is pacer:
            self._sleep(min(left, PATIENCE))
            if left > PATIENCE:
                self._look()
