"""What an exported policy says about itself: all that flying it needs to know, as JSON inside the file."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import Field, ValidationError, field_validator

from dq_marine.agents.environments import make_environment, marine
from dq_marine.agents.settings import EnvironmentSettings
from dq_marine.agents.strict_settings import Count, Natural, Number, Positive, Settings
from dq_marine.checks import shown
from dq_marine.envs.core.marine_env import MarineEnv
from dq_marine.errors import InvalidInputError
from dq_marine.vehicles.model import MOTIONS

METADATA_KEY = "dq_marine.policy"
"""Of the entry in an ONNX file's `metadata_props`, and of the extra file in a TorchScript archive."""

MEMORY, NEW_MEMORY = "memory", "new_memory"
"""What the graph of a policy that remembers is given besides observations, and gives besides actions."""

LONGEST_DESCRIPTION = 1 << 20
"""In characters; the longest of a task that ships has a few thousand."""

MOST_NAMED = 3
"""Of the observations that are missing where a policy is to fly, and of those besides, a message names so many."""

WRENCH_UNITS = dict(zip(MOTIONS, 3 * ("N",) + 3 * ("N m",), strict=True))


class ObservedPart(Settings):
    """Some numbers of the observation that belong together.

    Attributes:
        name: in snake case, with the frame.
        unit: such as "m/s"; "" for ratios.
        size: how many numbers.
        bound: their largest magnitude.
        input: the graph's input that they are among, in their order.
    """

    name: str
    unit: str
    size: Count
    bound: Positive
    input: str


class CommandedPart(Settings):
    """A number of the action.

    Attributes:
        name: of an axis such as "surge", or of an actuator's channel.
        unit: of `low` and `high`; "1" for a share of the largest speed.
        low: what the action -1 asks for.
        high: what the action 1 asks for.
    """

    name: str
    unit: str
    low: Number
    high: Number


class PolicyDescription(Settings):
    """Of a policy, what it was trained in and with, what it reads and what its actions mean.

    Attributes:
        format: of this description.
        environment: that it was trained in; its id names a registered task, and no module to import.
        vehicle: name of the environment's vehicle.
        level: of difficulty, if one was asked for.
        control_period: between two actions [s].
        observations: what the graph's inputs hold.
        actuation: what an action is: a "wrench" on the body, or commands of the "thrusters".
        actions: what the graph's output holds.
        memory: how many numbers the graph is given back that it gave the step before, zeros when an episode begins.
        algorithm: that trained it.
        seed: of the training.
        timesteps: that it had learned from.
        versions: of the libraries that it was trained with.
    """

    format: Literal[1] = 1
    environment: EnvironmentSettings
    vehicle: str
    level: str | None
    control_period: Positive
    observations: Annotated[tuple[ObservedPart, ...], Field(min_length=1)]
    actuation: str
    actions: Annotated[tuple[CommandedPart, ...], Field(min_length=1)]
    memory: Natural = 0
    algorithm: str
    seed: Natural
    timesteps: Natural
    versions: dict[str, str]

    @field_validator("environment")
    @classmethod
    def _imports_nothing(cls, environment: EnvironmentSettings) -> EnvironmentSettings:
        if ":" in environment.id:
            raise ValueError(f"{environment.id!r} would import a module; a description is data")
        return environment

    @classmethod
    def read(cls, text: str, *, source: str) -> Self:
        """Return the description of a file.

        Args:
            text: JSON.
            source: of which file, for the message.

        Raises:
            InvalidInputError: it is no description, or not one of this version.
        """
        try:
            if len(text) > LONGEST_DESCRIPTION:
                raise ValueError(f"it has {len(text)} characters, more than {LONGEST_DESCRIPTION}")
            return cls.model_validate_json(text)
        except ValidationError as error:
            first = error.errors(include_url=False)[0]
            place = ".".join(map(str, first["loc"]))
            reason = f"{place}: {first['msg']}" if place else first["msg"]
        except (ValueError, RecursionError) as error:
            reason = str(error)
        raise InvalidInputError(
            f"{source} describes its policy wrongly ({shown(reason)}); export it anew with `dq-marine export`"
        )

    @property
    def inputs(self) -> dict[str, int]:
        """How many numbers each input of the graph takes, by name."""
        sizes: dict[str, int] = {}
        for one in self.observations:
            sizes[one.input] = sizes.get(one.input, 0) + one.size
        return sizes

    def differences(self, env: MarineEnv) -> list[str]:
        """Return in what an environment's observations and actions are not those of the policy, for people to read."""
        wanted = {one.name: (one.unit, one.size) for one in self.observations}
        found = {one.name: (one.unit, one.size) for one in env.observations}
        said = _named_differences("observation", wanted, found)
        actions = {one.name: (one.unit, 1) for one in self.actions}
        said += _named_differences("action", actions, {one.name: (one.unit, 1) for one in commands_of(env)})
        return said


def described(
    environment: EnvironmentSettings,
    *,
    algorithm: str,
    seed: int,
    timesteps: int,
    versions: dict[str, str],
    memory: int = 0,
) -> PolicyDescription:
    """Return the description of a policy that was trained in an environment.

    Raises:
        InvalidInputError: the environment cannot be made any more.
    """
    env = make_environment(environment)
    inner = marine(env)
    goals = inner.definition.has_goals
    description = PolicyDescription(
        environment=environment.model_copy(update={"id": environment.id.rpartition(":")[2]}),
        vehicle=inner.vehicle.name,
        level=environment.keywords.get("level"),
        control_period=inner.control_period,
        observations=tuple(
            ObservedPart(
                name=one.name,
                unit=one.unit,
                size=one.size,
                bound=one.bound,
                input=one.part if goals else "observation",
            )
            for one in inner.observations
        ),
        actuation=inner.settings.actuation,
        actions=commands_of(inner),
        memory=memory,
        algorithm=algorithm,
        seed=seed,
        timesteps=timesteps,
        versions=versions,
    )
    env.close()
    return description


def commands_of(env: MarineEnv) -> tuple[CommandedPart, ...]:
    """Return what each number of an action asks for in an environment."""
    if env.settings.actuation == "wrench":
        limits = dict(zip(MOTIONS, env.vehicle.wrench_limits.tolist(), strict=True))
        return tuple(
            CommandedPart(name=name, unit=WRENCH_UNITS[name], low=-limits[name], high=limits[name])
            for name in env.action_names
        )
    channels = {one.name: one for one in env.vehicle.channels}
    return tuple(CommandedPart(**channels[name]._asdict()) for name in env.action_names)


def _named_differences(
    what: str, wanted: dict[str, tuple[str, int]], found: dict[str, tuple[str, int]]
) -> list[str]:
    """Return what is missing, what is there besides, and what is there but otherwise or elsewhere."""
    missing = [name for name in wanted if name not in found]
    besides = [name for name in found if name not in wanted]
    said = _named_first([f"no {what} {name}" for name in missing], f"more {what}s missing")
    said += _named_first([f"{what} {name} besides" for name in besides], f"more {what}s besides")
    for name in wanted.keys() & found.keys():
        (unit, size), (its_unit, its_size) = wanted[name], found[name]
        if (unit, size) != (its_unit, its_size):
            said.append(
                f"{what} {name} of {its_size} numbers in {its_unit or '1'}, not {size} in {unit or '1'}"
            )
    if not said and list(wanted) != list(found):
        said.append(f"{what}s in the order {', '.join(found)}")
    return said


def _named_first(said: list[str], rest: str) -> list[str]:
    """Return the first of what is said, and how many more there are."""
    more = len(said) - MOST_NAMED
    return said if more <= 1 else [*said[:MOST_NAMED], f"{more} {rest}"]
