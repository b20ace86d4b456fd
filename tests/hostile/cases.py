"""One hostile case: drawn from its seed, tried, and judged."""

from __future__ import annotations

import re
import traceback
import warnings
from typing import Any, NamedTuple

import gymnasium as gym
import numpy as np
import pydantic

from dq_marine.errors import DQMarineError
from hostile.acting import Target
from hostile.doors import DOORS, WEIGHTS

NAMES = tuple(name for name, weight in WEIGHTS.items() for _ in range(weight))

REFUSALS = (DQMarineError, gym.error.Error, pydantic.ValidationError)
"""What a door may raise: our own, Gymnasium's where its rules are broken, and pydantic's from its models."""

WRONG_CALL = re.compile(
    "unexpected keyword argument|required positional argument|positional arguments? but|multiple values"
)
"""What Python says of a call that does not fit a signature."""


class Verdict(NamedTuple):
    """How a case ended.

    Attributes:
        door: the one that was tried.
        outcome: "accepted", "refused", "raw" (another exception than ours), "wrong" (a refusal that changed
            something, or an acceptance after which steps are not finite or not repeatable).
        detail: what went wrong.
    """

    door: str
    outcome: str
    detail: str = ""


def judged(seed: int, door: str | None = None) -> Verdict:
    """Try the case of a seed, through one door or through the one that the seed draws."""
    rng = np.random.default_rng([seed, 1])
    drawn = NAMES[
        rng.integers(len(NAMES))
    ]  # even if a door is named: a case is the same by its seed and by both
    name = door or drawn
    chosen = DOORS[name]
    target = chosen.target() if chosen.target else None
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        if target:
            target.renew()
        try:
            call = chosen.draw(rng)
            before = target.state() if target else None
        except Exception:
            return Verdict(name, "wrong", "the case itself failed\n" + traceback.format_exc(limit=-6))
        try:
            call()
        except REFUSALS as error:
            return refused(name, target, before, error)
        except Exception as error:
            if isinstance(error, TypeError) and WRONG_CALL.search(str(error)):
                return refused(name, target, before, error)
            return Verdict(name, "raw", described(error))
        return accepted(name, target)


def refused(name: str, target: Target | None, before: Any, error: Exception) -> Verdict:
    """Judge a refusal: it says something, and changed nothing."""
    if not str(error).strip():
        return Verdict(name, "wrong", "refused without a word")
    if target and not same(before, target.state()):
        return Verdict(name, "wrong", f"a refusal changed the state: {error}")
    return Verdict(name, "refused")


def accepted(name: str, target: Target | None) -> Verdict:
    """Judge an acceptance: ten steps from there are finite, and the same ones again."""
    if target is None:
        return Verdict(name, "accepted")
    try:
        state = target.state()
        told = target.go_on()
        target.restore(state)
        again = target.go_on()
    except REFUSALS as error:
        return Verdict(name, "accepted", f"later refused: {error}")
    except Exception as error:
        return Verdict(name, "wrong", "after it was accepted: " + described(error))
    if not all(np.isfinite(one).all() for one in told):
        return Verdict(name, "wrong", "accepted, and then not finite")
    if not same(told, again):
        return Verdict(name, "wrong", "accepted, and then not repeatable")
    return Verdict(name, "accepted")


def same(one: Any, other: Any) -> bool:
    """Whether two nested values have the same bits."""
    if isinstance(one, dict):
        return one.keys() == other.keys() and all(same(one[key], other[key]) for key in one)
    if isinstance(one, list | tuple):
        return len(one) == len(other) and all(map(same, one, other))
    return bool(np.array_equal(one, other))


def described(error: BaseException) -> str:
    """Where an exception was raised, and what it says."""
    frames = traceback.extract_tb(error.__traceback__)
    ours = [frame for frame in frames if "dq_marine" in frame.filename or "/envs/" in frame.filename]
    place = ours[-1] if ours else frames[-1]
    try:
        text = str(error)
    except Exception:
        text = "?"
    file = place.filename.rsplit("dq_marine", 1)[-1]
    return f"{type(error).__name__}: {text[:200]} at {file}:{place.lineno} {place.name}"
