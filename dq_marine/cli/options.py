"""Options that commands share."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from dq_marine.agents.strict_settings import Settings


SECONDS = 30.0
"""How long a flight is if nobody says so [s]."""


class Algorithm(StrEnum):
    """What `--algorithm` takes."""

    PPO = "ppo"
    RECURRENT_PPO = "recurrent_ppo"
    SAC = "sac"
    TD3 = "td3"
    TQC = "tqc"
    CROSSQ = "crossq"


class Baseline(StrEnum):
    """What `--agent` takes."""

    CONTROLLER = "controller"
    ZERO = "zero"
    RANDOM = "random"
    LQR = "lqr"
    MPC = "mpc"


def baselines_option(default: str) -> Any:
    """Return the option `--agent` of commands that several baselines fly for.

    Args:
        default: who flies if nobody is named, for `--help`.
    """
    return typer.Option(
        "--agent", help="A baseline; may be repeated. lqr and mpc need the extra `mpc`.", show_default=default
    )


RunsOption = Annotated[
    list[Path] | None,
    typer.Option("--run", help="Folder of a training run; may be repeated. Load only runs you trust."),
]
TaskOption = Annotated[
    str | None,
    typer.Option(
        "--task",
        help="Name of a task, or id as for gym.make; MODULE:ID imports a module first, which registers it.",
        show_default="StationKeeping, or the preset's or run's",
    ),
]
VehicleOption = Annotated[
    str | None,
    typer.Option(
        "--vehicle",
        help="Catalogue name, or path of a TOML file.",
        show_default="bluerov2_heavy, or the preset's or run's",
    ),
]
LevelOption = Annotated[
    str | None,
    typer.Option(
        "--level",
        help="Of difficulty, such as easy, medium or hard; `dq-marine tasks TASK` says what a task's levels are.",
        show_default="none, or the preset's or run's",
    ),
]
CurrentOption = Annotated[
    str | None,
    typer.Option(
        "--current",
        help="Speed in m/s: every episode draws a horizontal current of up to it. Or three components in NED, "
        "always the same: 0.2,-0.1,0.",
        show_default="0.3, or the preset's or run's",
    ),
]
PerturbOption = Annotated[
    list[str] | None,
    typer.Option(
        "--perturb",
        metavar="NAME",
        help="What does not go as planned: late_actions, old_observations, lost_thruster, payload, "
        "unknown_vehicle, strong_current or faulty_sensors; may be repeated. It wins over what a preset or a run says.",
    ),
]
SetOption = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="KEY=VALUE",
        help="Any keyword of the environment; may be repeated. The value is TOML or JSON, a dot reaches into a table, "
        "null takes the default. A wrong key is answered with the list of keys.",
    ),
]
AlgorithmOption = Annotated[
    Algorithm | None,
    typer.Option(
        "--algorithm",
        help="Learning algorithm, with the preset of its name; with the preset of a task, that task by this algorithm.",
        show_default="ppo, or the preset's",
    ),
]
TrainingPresetOption = Annotated[
    str | None,
    typer.Option(
        "--preset",
        help="Name of a preset, of an algorithm or of a task whose policy comes with this package; or path of a TOML "
        "file.",
        show_default="the algorithm's",
    ),
]
EnvsOption = Annotated[
    int | None,
    typer.Option("--envs", min=1, help="Number of environments to learn from.", show_default="the preset's"),
]
ProcessesOption = Annotated[
    int | None,
    typer.Option("--processes", min=1, max=256, help="How many work at a time.", show_default="all cores"),
]
DistributedOption = Annotated[
    bool,
    typer.Option(
        "--distributed",
        help="Spread the work by Ray, which gives the work of a machine that is lost to others. All machines need this "
        'package: pip install "dq-marine[distributed]".',
    ),
]
AddressOption = Annotated[
    str | None,
    typer.Option(
        "--address",
        metavar="HOST:PORT",
        help="Of a cluster of Ray, as `ray start --head` prints it, with --distributed.",
        show_default="one that is begun on this machine",
    ),
]
POLICY = (
    "Exported policy (.onnx); name of a task whose policy comes with this package, such as StationKeeping; or "
    "hf://OWNER/NAME@REVISION on the Hugging Face Hub"
)
PolicyOption = Annotated[str | None, typer.Option("--policy", help=f"{POLICY}: it flies, without torch.")]
PoliciesOption = Annotated[list[str] | None, typer.Option("--policy", help=f"{POLICY}; may be repeated.")]
StartSeedOption = Annotated[
    int | None,
    typer.Option(
        "--seed",
        min=0,
        help="Seed of the start and the current.",
        show_default="the scenario's, or the first whose start is at least half the start radius from the goal",
    ),
]
PrintPresetOption = Annotated[
    bool,
    typer.Option("--print-preset", help="Print the settings as TOML, which --preset reads, and exit."),
]
ScenarioOption = Annotated[
    str | None,
    typer.Option(
        "--scenario",
        help="Begin a scenario: its name, as StationKeeping/calm, or the path of a TOML file. Other options that say "
        "something of the environment win over what it says. `dq-marine scenarios` lists them.",
    ),
]
EnvironmentPresetOption = Annotated[
    str | None,
    typer.Option("--preset", help="Name of a preset, or path of a TOML file, whose environment is used."),
]


def print_preset(settings: Settings, table: str | None = None) -> None:
    """Print settings as TOML, within a table if one is named."""
    from dq_marine.util.toml_text import toml_text

    content = settings.model_dump(mode="json")
    typer.echo(toml_text(content if table is None else {table: content}), nl=False)
