"""Which parts of an observation tell of several things of a kind, numbered by their names, such as vessels 1 to 3."""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterable
from typing import Any

import gymnasium as gym

from dq_marine.agents.environments import space_shape
from dq_marine.envs.core.definition import Observed
from dq_marine.errors import InvalidInputError

NUMBERED = re.compile(r"(?P<kind>\w+?)_(?P<number>\d+)_(?P<what>\w+)")
"""Names of parts of things that are numbered, such as vessel_2_course_level."""

Places = list[int]


def things_of(observations: Iterable[Observed]) -> tuple[Places, list[list[Places]]]:
    """Return where, in an observation, is what is not numbered; and of each kind of things where each of them is.

    One thing alone of a kind is read as if it were not numbered.

    Raises:
        InvalidInputError: there are no two things of a kind, or two things of a kind are shown differently.
    """
    alone: Places = []
    kinds: dict[str, dict[str, list[tuple[str, int]]]] = {}
    places = itertools.count()
    for one in observations:
        own = list(itertools.islice(places, one.size))
        found = NUMBERED.fullmatch(one.name)
        if found is None:
            alone += own
        else:
            thing = kinds.setdefault(found["kind"], {}).setdefault(found["number"], [])
            thing += [(found["what"], place) for place in own]
    single = [kind for kind, things in kinds.items() if len(things) == 1]
    for kind in single:
        (thing,) = kinds.pop(kind).values()
        alone += [place for _, place in thing]
    alone.sort()
    if not kinds:
        raise InvalidInputError(
            "network.set_layers read several numbered things of a kind in an observation, such as vessel_1_rules and "
            "vessel_2_rules, and this environment shows none; leave set_layers out"
        )
    for kind, things in kinds.items():
        if len({tuple(what for what, _ in thing) for thing in things.values()}) > 1:
            raise InvalidInputError(
                f"network.set_layers read each {kind} alike, and {', '.join(things)} are shown differently; leave "
                "set_layers out"
            )
    return alone, [[[place for _, place in thing] for thing in things.values()] for things in kinds.values()]


def check_one_part(space: gym.Space[Any]) -> None:
    """Check that observations are of one part, in which `things_of` tells the places.

    Raises:
        InvalidInputError: they are a dictionary of parts.
    """
    if not isinstance(space, gym.spaces.Box):
        raise InvalidInputError(
            "network.set_layers read observations of one part, and these have "
            f"{list(space_shape(space))}; leave set_layers out, or goals out of the environment"
        )
