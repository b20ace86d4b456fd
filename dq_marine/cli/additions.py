"""What it takes to add a task, a force, a sensor, a reward term or a vehicle: one text for the command and the page."""

from __future__ import annotations

from dataclasses import dataclass
from importlib import resources
from typing import NamedTuple


class Change(NamedTuple):
    """A file of the repository that an addition creates or edits.

    Attributes:
        path: from the repository's root; of a file to create, its folder.
        change: what is written there.
    """

    path: str
    change: str


@dataclass(frozen=True)
class Addition:
    """How something is added.

    Attributes:
        name: of the kind of thing, for the command.
        heading: for the page.
        what: what it consists of.
        outside: the call that takes it, from outside the package.
        inside: the files that change where it is to ship with the package.
        template: name of a file that works as it is; save it under this name and change it.
        result: a command that shows the result, to be run in the folder of that file.
    """

    name: str
    heading: str
    what: str
    outside: str
    inside: tuple[Change, ...]
    template: str
    result: str

    @property
    def text(self) -> str:
        """Content of the template."""
        return (resources.files("dq_marine.cli") / "templates" / self.template).read_text(encoding="utf-8")

    @property
    def language(self) -> str:
        """Of the template."""
        return "toml" if self.template.endswith(".toml") else "python"

    def markdown(self) -> str:
        """Return the addition as a section of a page."""
        changes = "\n".join(f"- `{change.path}`: {change.change}" for change in self.inside)
        return (
            f"### {self.heading}\n\n{self.what}\n\n"
            f"From outside the package: `{self.outside}`. Inside it, these files change:\n\n{changes}\n\n"
            f"`{self.template}`:\n\n```{self.language}\n{self.text}```\n\n```\n{self.result}\n```\n"
        )


TASK = Addition(
    name="task",
    heading="A task",
    what="A file with plain functions and named tuples, whose last line calls `define_task`.",
    outside='gym.make("depth_keeping:my/DepthKeeping-v0"), gym.make_vec(...)',
    inside=(
        Change("envs/tasks/", "the file; every file in this folder is registered"),
        Change(
            "envs/scenarios/", "a TOML file with its scenarios, 20 or more; every file in this folder is read"
        ),
        Change("docs/tasks/", "its page, which `dq-marine tasks --pages docs/tasks --pictures` writes"),
    ),
    template="depth_keeping.py",
    result="python -m dq_marine fly --task depth_keeping:my/DepthKeeping-v0 --agent random --trajectory flight.csv",
)

FORCE = Addition(
    name="force",
    heading="A force",
    what="A function `(parameters, pose, time) -> Spatial`, or with the velocity `(parameters, pose, twist, time) -> "
    "Spatial` and `uses_velocity=True`, or without the pose `(parameters, time) -> Spatial` and `uses_pose=False`; and "
    "a `ForceTerm` that holds it and its numbers.",
    outside="Scene(forces=[TETHER]), gym.make(..., forces=[TETHER])",
    inside=(
        Change(
            "dq_marine/physics/",
            "a folder with `formulas.py` (the function and its parameters), `build.py` (from a vehicle to its "
            "`ForceTerm`s, none where the force is zero) and an empty `__init__.py`; `tables.py` and a field of "
            "`Vehicle` if the vehicle's file describes it",
        ),
        Change("dq_marine/simulation/scene.py", "`*tether_terms(self.vehicle)` in the tuple `present`"),
        Change("pyproject.toml", "the folder's name among `packages`"),
        Change("tests/integrator/test_order.py", "a case, so that the order of the method is tested with it"),
        Change("tests/support/fossen.py", "the same force, written separately"),
    ),
    template="tether.py",
    result='python -c "import dq_marine, tether; print(dq_marine.Scene(forces=[tether.TETHER]).terms)"',
)

SENSOR = Addition(
    name="sensor",
    heading="A sensor",
    what="A class derived from `Sensor`, with its errors as attributes, and an `Instrument`: what is measured and when "
    "it can be; with `believe`, which part of the motion it replaces; with `show`, what joins the observation.",
    outside="gym.make(..., sensors=[Altimeter(noise=0.1, rate=5.0)])",
    inside=(
        Change("dq_marine/task/sensors/", "the file"),
        Change(
            "dq_marine/task/sensors/build.py",
            'its import, and `"altimeter": Altimeter,` as the last line of `KINDS`: dictionaries and JSON then know it',
        ),
        Change("dq_marine/__init__.pyi", "its import, which makes the name public"),
    ),
    template="altimeter.py",
    result="python -c \"import gymnasium, dq_marine, altimeter; print(*gymnasium.make('dq_marine/StationKeeping-v0', "
    "sensors=[altimeter.Altimeter()]).unwrapped.observations, sep='\\n')\"",
)

REWARD = Addition(
    name="reward",
    heading="A reward term",
    what="A function of the situation at the end of a control period. `info` and TensorBoard show each term by name.",
    outside='gym.make(..., extra_rewards=[CALM]); other weights for a task\'s own terms: reward={"effort": 0.1}',
    inside=(
        Change(
            "envs/tasks/station_keeping.py",
            "or another task's file: a field of `Rewards`, its default the weight (in `Weights`, where there is one), "
            "and a value in what `reward` returns",
        ),
    ),
    template="calm.py",
    result="python -c \"import gymnasium, dq_marine, calm; print(gymnasium.make('dq_marine/StationKeeping-v0', "
    'extra_rewards=[calm.CALM]).reset(seed=0)[1])"',
)

VEHICLE = Addition(
    name="vehicle",
    heading="A vehicle",
    what="A TOML file. `dq-marine vehicles export NAME` writes one of the catalogue to start from, with thrusters and "
    "sources.",
    outside='Scene("my_vehicle.toml"), gym.make(..., vehicle="my_vehicle.toml")',
    inside=(
        Change(
            "dq_marine/vehicles/catalogue/",
            "the file, whose name becomes the vehicle's; tests check every file",
        ),
    ),
    template="my_vehicle.toml",
    result="dq-marine vehicles check my_vehicle.toml",
)

ADDITIONS = {one.name: one for one in (TASK, FORCE, SENSOR, REWARD, VEHICLE)}
"""By name."""
