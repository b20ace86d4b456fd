"""Line-of-sight guidance: from where a vehicle is beside a path to the course that leads it there.

With cross-track error e, look-ahead distance D and a path at the angle pi, a vehicle shall go along

    chi_d = pi - atan(e / D) - b,        db/dt = g D e / sqrt(D^2 + e^2)                               (1)

(Fossen 2023, An adaptive line-of-sight guidance law for path following of vehicles and unmanned aircraft, for the level
plane; the same with elevation for the vertical). There b is the crab angle, which nobody measures; here the velocity
over ground is observed, its direction is led along (1), and b is what remains: a curved path and a lagging autopilot.
"""

from __future__ import annotations

import math


class AdaptiveSight:
    """The law (1) in one plane."""

    def __init__(self, look_ahead: float, adaptation: float, largest: float, period: float) -> None:
        """Take the numbers of the law.

        Args:
            look_ahead: D [m].
            adaptation: of 0, plain line of sight; of 1, g = U / (4 D^3), which damps e critically at the speed U.
            largest: bound of b [rad].
            period: between calls [s].
        """
        self._look_ahead, self._adaptation = look_ahead, adaptation
        self._largest, self._period = largest, period
        self._found = 0.0

    def reset(self) -> None:
        """Forget b."""
        self._found = 0.0

    def correction(self, error: float, speed: float) -> float:
        """Return chi_d - pi [rad] at a cross-track error [m] and a speed [m/s], and advance b by a period."""
        reach = self._look_ahead
        sight = math.atan2(error, reach)
        rate = self._adaptation * speed / (4.0 * reach**2) * error / math.hypot(1.0, error / reach)
        correction = -sight - self._found
        self._found = max(-self._largest, min(self._largest, self._found + self._period * rate))
        return correction


def level_angles(down_body: tuple[float, float, float]) -> tuple[float, float]:
    """Return roll and pitch [rad] of a vehicle that sees down in this direction."""
    x, y, z = down_body
    return math.atan2(y, z), math.atan2(-x, math.hypot(y, z))


def levelled(
    vector_body: tuple[float, float, float], roll: float, pitch: float
) -> tuple[float, float, float]:
    """Return a vector's components ahead, to starboard and down, of a level vehicle that heads the same way."""
    x, y, z = vector_body
    starboard = math.cos(roll) * y - math.sin(roll) * z
    below = math.sin(roll) * y + math.cos(roll) * z
    return (
        math.cos(pitch) * x + math.sin(pitch) * below,
        starboard,
        math.cos(pitch) * below - math.sin(pitch) * x,
    )


def no_turn_leads_to(ahead: float, starboard: float, radius: float) -> bool:
    """Whether a place, in metres from a vehicle along its bow, is within the circle of a turn of a radius [m] there."""
    return math.hypot(ahead, abs(starboard) - radius) < radius


def wrapped(angle: float) -> float:
    """Return an angle within -pi and pi."""
    return math.remainder(angle, 2.0 * math.pi)
