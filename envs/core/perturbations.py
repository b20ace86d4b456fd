"""What does not go as planned at sea, by name: keywords of environments, for training and for evaluation."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

from dq_marine.checks import one_of, shown
from dq_marine.envs.core.definition import TaskDefinition
from dq_marine.envs.core.proportion import current_for
from dq_marine.errors import InvalidInputError


@dataclass(frozen=True)
class Perturbation:
    """Something that does not go as planned.

    Attributes:
        about: in a few words.
        keywords: of an environment, that make it so; a value may be a `ForVehicle`.
    """

    about: str
    keywords: Mapping[str, Any]


PERTURBATIONS: Mapping[str, Perturbation] = MappingProxyType(
    {
        "late_actions": Perturbation("actions arrive two control periods late", {"action_delay": 2}),
        "old_observations": Perturbation(
            "what the agent is shown is two control periods old", {"observation_delay": 2}
        ),
        "lost_thruster": Perturbation(
            "one propeller, a different one in each episode, gives no thrust",
            {"actuation": "thrusters", "randomise": "lost_thruster"},
        ),
        "payload": Perturbation(
            "up to 10 % heavier, out of trim and not ballasted", {"randomise": "payload"}
        ),
        "unknown_vehicle": Perturbation(
            "mass, added mass, damping, trim and thrust differ from episode to episode",
            {"randomise": "default"},
        ),
        "strong_current": Perturbation(
            "a current of up to half of the cruising speed", {"current": current_for(0.5)}
        ),
        "faulty_sensors": Perturbation(
            "half of the DVL's readings are lost, and the heading is some 3 degrees off",
            {"sensors": {"dvl": {"noise": 0.01, "dropout": 0.5}, "ahrs": {"noise": 0.01, "bias": 0.05}}},
        ),
    }
)


def perturbed(
    definition: TaskDefinition, perturb: str | Sequence[str] | None, given: Mapping[str, Any]
) -> dict[str, Any]:
    """Return keywords, with those of perturbations for what is not given.

    Args:
        definition: of the task.
        perturb: a name, several, or None.
        given: keywords of an environment of the task.

    Raises:
        InvalidInputError: a name is unknown, or two of them say different things of one keyword.
    """
    names = [] if perturb is None else [perturb] if isinstance(perturb, str) else perturb
    if not isinstance(names, list | tuple):
        raise InvalidInputError(
            f"perturb = {shown(perturb)}; give a name or a list of some of {list(PERTURBATIONS)}"
        )
    said: dict[str, Any] = {}
    for name in names:
        for keyword, value in PERTURBATIONS[one_of("perturb", name, PERTURBATIONS)].keywords.items():
            if said.setdefault(keyword, value) != value and keyword not in given:
                raise InvalidInputError(
                    f"perturb = {list(names)}: two of them say what {keyword} is; give {keyword} yourself, or leave "
                    "one out"
                )
    return {**{name: definition.for_vehicle(value, given) for name, value in said.items()}, **given}
