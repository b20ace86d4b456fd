"""A controller that meets a partner and stays beside it: a filter, constant-bearing guidance, and the autopilot.

Where it joins an episode under way, it has heard too little for its filter, and goes by the running fix.
"""

from __future__ import annotations

import math
from typing import Any, ClassVar, NamedTuple

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from dq_marine.agents.controllers.autopilot import Attitude, seen
from dq_marine.agents.controllers.formation_filter import turned
from dq_marine.agents.controllers.guidance import wrapped
from dq_marine.agents.controllers.journeys import MOTION, GuidedJourney
from dq_marine.agents.controllers.line_of_sight import Offset
from dq_marine.agents.controllers.partner_filter import PartnerFilter, Told
from dq_marine.agents.settings import AutopilotSettings
from dq_marine.algebra.level import Level
from dq_marine.envs.core.marine_env import Action
from dq_marine.envs.core.observation import Observation

Array = NDArray[np.float64]

TOLD = ("told", "age", "range", "position_level", "deeper", "course_level", "speed")

FIX = ("told", "bearing_level", "distance")

CATCHING_UP, BY_FIX = 4.0, 12.0
"""In which the way to the place beside the partner is closed at the partner's speed, were it kept up [lengths].

By the running fix that takes longer: it errs otherwise in each period, which a filter does not."""

HASTE = 0.6
"""Largest velocity towards that place, as the partner sees it, over the partner's speed."""

SLOWEST = 0.5
"""Least speed over ground, over the partner's: a vehicle without way on cannot be steered."""

BESIDE = 0.5
"""Place beside the partner, from what is safe (0) to where one has met (1)."""

CLEAR = 2.0
"""Out of the way of a partner that comes: so far beside its course [distance of the place]."""

UNDECIDED = 0.15
"""The side of the partner is kept until the vehicle is as far on the other [distance of the place]."""

AWAY = 2.0
"""Of a partner that is nearer than the place beside it: way from it, over what is lacking."""

DEPTH_GAIN, SINKING_GAIN = 0.6, 0.2
"""Of what packets tell of the partner's depth: a filter of two constant gains."""


class Partner(NamedTuple):
    """Where the partner is, seen from the vehicle [m], and how it goes [m/s], in north and east."""

    north: float
    east: float
    v_north: float
    v_east: float


class RendezvousController(GuidedJourney):
    """Estimates where its partner is and how it goes, and closes in on a place beside it."""

    READS: ClassVar[tuple[str, ...]] = (
        *(f"packet_1_{part}" for part in TOLD),
        *(f"fix_1_{part}" for part in FIX),
        "bow_north_east",
        "deeper_than_plan",
        "partner_speed",
        "meeting_distance",
        "safe_distance",
        *MOTION,
    )

    def __init__(self, env: gym.Env[Any, Any], autopilot: AutopilotSettings | None = None) -> None:
        """Prepare for an environment's vehicle; None reads the preset `autopilot`."""
        super().__init__(env, autopilot)
        self._forget()

    def reset(self, env: gym.Env[Any, Any] | None = None) -> None:
        """Forget the episode before."""
        super().reset(env)
        self._forget()

    def act(self, observation: Observation) -> Action:
        """Return the action in [-1, 1], shape (n,)."""
        parts = self._read(observation)
        attitude = seen(parts)
        north, east = parts["bow_north_east"].tolist()
        bow = math.atan2(east, north)
        self._bow = bow
        self._hear(parts, attitude, bow)
        speed = float(parts["partner_speed"][0])
        partner = self._partner
        if partner is None:
            wanted = turned((speed, 0.0), self._blind_course(parts))
        else:
            safe, meeting = (float(parts[f"{name}_distance"][0]) for name in ("safe", "meeting"))
            wanted = self._wanted(partner, self._velocity, safe + BESIDE * (meeting - safe), speed)
        fast = math.hypot(*wanted)
        way = turned((wanted[0] / fast, wanted[1] / fast), -bow)
        turn = abs(wrapped(math.atan2(way[1], way[0]) - attitude.drift_angle))
        fast = min(fast, max(speed, fast * (1.0 - turn / self._settings.slowing_angle)))
        below = float(parts["deeper_than_plan"][0]) - self._depth
        order = self._guidance.order_along(
            attitude, fast, (*way, self._sinking / fast), 0.0, Offset(0.0, below)
        )
        return self._pilot.act(attitude, order)

    @property
    def estimate(self) -> Array:
        """Where the partner is [m] and how it goes [m/s], each ahead and to starboard, and how deep [m], shape (5,)."""
        north, east, v_north, v_east = self._partner or Partner(0.0, 0.0, 0.0, 0.0)
        place, going = turned((north, east), -self._bow), turned((v_north, v_east), -self._bow)
        return np.array([*place, *going, self._depth])

    @property
    def _partner(self) -> Partner | None:
        """What is known of the partner; None where nothing is."""
        return self._fix if self._filter is None else Partner(*self._filter.likeliest.tolist())

    def _blind_course(self, parts: dict[str, Array]) -> float:
        """Return where to go while the partner might be anywhere [rad]: on, or to starboard of one that comes closer.

        That is the rule of the road for meeting head on, and where it comes from shows while the vehicle turns.
        """
        comes = parts["packet_1_told"][1] > 0.5 and parts["packet_1_course_level"][0] < 0.0
        return self._bow + 0.5 * math.pi if comes else self._first_bow or 0.0

    def _forget(self) -> None:
        """Begin anew."""
        self._filter: PartnerFilter | None = None
        self._joined = False
        self._fix: Partner | None = None
        self._first_bow: float | None = None
        self._velocity: Level = (0.0, 0.0)
        self._side, self._bow = 1.0, 0.0
        self._age, self._silence, self._depth, self._sinking = math.inf, 0.0, 0.0, 0.0

    def _wanted(self, partner: Partner, own: Level, beside: float, planned: float) -> Level:
        """Return the velocity in north and east [m/s] for a place beside the partner [m].

        It is the partner's and what closes in on the place, so that the bearing there stays (Breivik & Fossen 2008,
        "Guidance laws for planar motion control", 47th IEEE CDC, 570). Out of the way of one who comes towards
        the vehicle, that turns first, to the side on which it would pass anyway: else it might turn to and fro.

        Args:
            partner: as the filter has it.
            own: one's own velocity in north and east [m/s].
            beside: distance of the place from the partner [m].
            planned: its speed [m/s].
        """
        course = math.atan2(partner.v_east, partner.v_north)
        ahead, starboard = turned((-partner.north, -partner.east), -course)  # of the partner
        onward, aside = turned(own, -course)
        comes = ahead > 0.0 and onward < 0.0
        fast = math.hypot(partner.v_north, partner.v_east)
        passing = starboard + aside * ahead / (fast - onward) if comes else starboard
        self._side = math.copysign(1.0, passing) if abs(passing) > UNDECIDED * beside else self._side
        if comes and abs(passing) < CLEAR * beside:
            return turned((0.0, self._side * planned), course)
        away = AWAY * max(0.0, beside / max(1e-9, math.hypot(ahead, starboard)) - 1.0)
        to_place = ((away - 1.0) * ahead, self._side * beside + (away - 1.0) * starboard)
        distance = max(1e-9, math.hypot(*to_place))
        catching_up = BY_FIX if self._filter is None else CATCHING_UP
        closing = min(HASTE * planned, distance * planned / (catching_up * self._pilot.length))
        along = max(SLOWEST * planned, fast + closing * to_place[0] / distance)
        return turned((along, closing * to_place[1] / distance), course)

    def _hear(self, parts: dict[str, Array], attitude: Attitude, bow: float) -> None:
        """Bring what is known of the partner up to now."""
        ahead, starboard, _ = attitude.velocity_level
        self._velocity = velocity = turned((ahead, starboard), bow)
        self._first_bow = bow if self._first_bow is None else self._first_bow
        self._depth += self._pilot.period * self._sinking
        self._silence += self._pilot.period
        if self._filter is not None:
            self._filter.predict(velocity, self._pilot.period)
        age, (heard, course, position) = float(parts["packet_1_age"][0]), parts["packet_1_told"] > 0.5
        joins, new, self._age = math.isinf(self._age), heard and age < self._age, age
        own_depth = float(parts["deeper_than_plan"][0])
        self._joined |= joins and course
        if self._joined:
            self._fix = _fixed(parts, bow)
            self._depth = own_depth + float(parts["packet_1_deeper"][0])
            return
        if not new:
            return
        if course:
            off = own_depth + float(parts["packet_1_deeper"][0]) + age * self._sinking - self._depth
            self._depth += DEPTH_GAIN * off
            self._sinking += SINKING_GAIN * off / self._silence
            self._silence = 0.0
        told = Told(
            age,
            float(parts["packet_1_range"][0]),
            self._depth - own_depth,
            _told_velocity(parts, bow) if course else None,
            turned(tuple(parts["packet_1_position_level"].tolist()), bow) if position else None,
        )
        speed = float(parts["partner_speed"][0])
        if self._filter is None:
            self._filter = PartnerFilter(told, self._first_bow, speed)
        elif self._filter.lost:
            self._filter = PartnerFilter(told, bow, speed, math.pi)
        else:
            self._filter.update(told, velocity)


def _fixed(parts: dict[str, Array], bow: float) -> Partner | None:
    """Return where the partner is by the running fix, for who joins an episode under way; None where there is none."""
    if parts["fix_1_told"][0] < 0.5:
        return None
    place = float(parts["fix_1_distance"][0]) * parts["fix_1_bearing_level"]
    return Partner(*turned(tuple(place.tolist()), bow), *_told_velocity(parts, bow))


def _told_velocity(parts: dict[str, Array], bow: float) -> Level:
    """Return what the last packet tells of the partner's velocity, in north and east [m/s]."""
    velocity = float(parts["packet_1_speed"][0]) * parts["packet_1_course_level"]
    return turned(tuple(velocity.tolist()), bow)
