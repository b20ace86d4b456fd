"""A slice of the campaign of hostile cases, through every door; `python benchmarks/hostile.py` tries any number."""

import pytest
from support.sweeps import sweep

from hostile.cases import judged
from hostile.doors import DOORS

LONG = ("environment", "vector environment", "radiation file", "mesh file", "run folder", "command")
"""Doors whose cases take long: something is composed, read or trained anew for each."""


FOUND = ((6021799, "run folder"), (6024489, "vehicle"), (6027236, "vehicle"))
"""Seeds and doors of cases that once ended badly. They mean the same as long as these doors are drawn the same way."""


@pytest.mark.parametrize(("seed", "door"), FOUND)
def test_what_the_campaign_found_is_mended(seed, door):
    verdict = judged(seed, door)
    assert verdict.outcome in ("refused", "accepted"), verdict


@pytest.mark.parametrize("door", DOORS)
def test_hostile_cases_are_refused_or_harmless(door):
    for seed in range(8 if door in LONG else 40):
        verdict = judged(seed, door)
        assert verdict.outcome in ("refused", "accepted"), (seed, verdict)


@pytest.mark.parametrize("first", sweep(range(0, 4000, 1000), plain=[0]))
def test_cases_of_the_campaign(first):
    for seed in range(first, first + (1000 if first else 100)):
        verdict = judged(seed)
        assert verdict.outcome in ("refused", "accepted"), (seed, verdict)


def test_the_campaign_has_both_ends():
    """It would show nothing if all were refused, or none."""
    outcomes = {judged(seed, "body").outcome for seed in range(40)}
    assert outcomes == {"refused", "accepted"}
