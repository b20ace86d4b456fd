"""Perturbations by name: the keywords that they stand for, and who wins over whom."""

from pathlib import Path
from typing import get_args

import gymnasium as gym
import numpy as np
import pytest
from support.environments import STATION_KEEPING, StationKeepingEnv
from support.sweeps import sweep

from dq_marine.agents.settings import EnvironmentSettings
from dq_marine.cli.agent_options import EnvironmentOptions
from dq_marine.cli.options import PerturbOption
from dq_marine.envs import PERTURBATIONS
from dq_marine.envs.core.suitability import cruising_speed
from dq_marine.errors import InvalidInputError


def settings_of(**keywords):
    return StationKeepingEnv(vehicle_pool=3, **keywords).settings


@pytest.mark.parametrize("name", sweep(PERTURBATIONS, plain=["late_actions"]))
def test_a_perturbed_environment_is_that_of_the_keywords_it_stands_for(name):
    perturbed = StationKeepingEnv(perturb=name, vehicle_pool=3)
    keywords = {
        keyword: perturbed.definition.for_vehicle(value, {})
        for keyword, value in PERTURBATIONS[name].keywords.items()
    }
    assert perturbed.settings == StationKeepingEnv(**keywords, vehicle_pool=3).settings
    assert perturbed.settings != settings_of()
    perturbed.reset(seed=0)
    for action in np.random.default_rng(0).uniform(-1.0, 1.0, (20, *perturbed.action_space.shape)):
        observation, reward, *_ = perturbed.step(action)
        assert np.isfinite(observation).all()
        assert np.isfinite(reward)


@pytest.mark.sweep
def test_what_is_given_wins_over_a_perturbation_and_that_over_a_level():
    level = settings_of(level="hard")
    both = settings_of(level="hard", perturb=["strong_current", "late_actions"], action_delay=5)
    assert both.action_delay == 5
    assert both.water.speed == pytest.approx(0.5 * cruising_speed(both.flown))
    assert level.water.speed != both.water.speed
    assert settings_of(perturb=["payload", "lost_thruster"], randomise="payload").actuation == "thrusters"


def test_the_page_says_of_each_what_happens():
    page = (Path(__file__).parents[3] / "docs" / "howto" / "perturb.md").read_text(encoding="utf-8")
    for name, one in PERTURBATIONS.items():
        assert f"| `{name}` | {one.about} |" in page


def test_the_option_names_them_all():
    (option,) = (one for one in get_args(PerturbOption) if hasattr(one, "help"))
    for name in PERTURBATIONS:
        assert name in option.help


def test_wrong_names_are_refused():
    for perturb, message in (
        ("waves", r"perturb = 'waves' is unknown; give one of .*late_actions"),
        (["payload", "gremlins"], r"perturb = 'gremlins' is unknown"),
        (3, r"perturb = 3; give a name or a list"),
        (["payload", "lost_thruster"], r"two of them say what randomise is"),
    ):
        with pytest.raises(InvalidInputError, match=message):
            gym.make(STATION_KEEPING, perturb=perturb)


def test_a_body_that_is_driven_by_a_wrench_has_no_propeller_to_lose():
    with pytest.raises(InvalidInputError, match=r"loses 1 of the propellers.*give actuation = 'thrusters'"):
        StationKeepingEnv(perturb="lost_thruster", actuation="wrench")


def test_the_option_wins_over_what_a_run_was_trained_in_but_not_over_what_is_set():
    trained = EnvironmentSettings(id=STATION_KEEPING, keywords={"current": 0.1, "action_delay": 1})
    options = EnvironmentOptions(perturb=("strong_current", "late_actions"))
    assert options.applied(trained).keywords == {"perturb": ["strong_current", "late_actions"]}
    options = EnvironmentOptions(perturb=("late_actions",), keywords=("action_delay=3",))
    assert options.applied(trained).keywords == {
        "current": 0.1,
        "action_delay": 3,
        "perturb": ["late_actions"],
    }
    with pytest.raises(InvalidInputError, match="--perturb = 'storm' is unknown"):
        EnvironmentOptions(perturb=("storm",)).applied(trained)
    with pytest.raises(InvalidInputError, match="both say it"):
        EnvironmentOptions(perturb=("payload",), keywords=("perturb=late_actions",)).applied(trained)
