"""The commands `dq-marine manoeuvre VEHICLE ...`: one for each standard manoeuvre."""

from __future__ import annotations

import json as json_format
import math
from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.markup import escape

from dq_marine.cli.common import HELP_OPTIONS, console, error_console, examples

if TYPE_CHECKING:
    from dq_marine.manoeuvres import Result
    from dq_marine.vehicles import Vehicle

app = typer.Typer(rich_markup_mode="rich", context_settings=HELP_OPTIONS)


class SideName(StrEnum):
    """What `--side` takes."""

    STARBOARD = "starboard"
    PORT = "port"


class MotionName(StrEnum):
    """What `--motion` takes."""

    ROLL = "roll"
    PITCH = "pitch"
    HEAVE = "heave"


class OrderName(StrEnum):
    """What `--order` takes."""

    ASTERN = "astern"
    OFF = "off"


class ActuationName(StrEnum):
    """What `--actuation` takes."""

    WRENCH = "wrench"
    THRUSTERS = "thrusters"


class RadiationName(StrEnum):
    """What `--radiation` takes."""

    CONSTANT = "constant"
    MEMORY = "memory"


ActuationOption = Annotated[
    ActuationName | None,
    typer.Option(
        "--actuation",
        help="What throttle and helm act on: a force and a moment within the vehicle's limits, or its thrusters "
        "and fins.",
        show_default="thrusters, if its file has them",
    ),
]
ThrottleOption = Annotated[
    float, typer.Option("--throttle", help="Throttle of the approach, above 0 and up to 1.")
]
RadiationOption = Annotated[
    RadiationName,
    typer.Option(
        "--radiation",
        help="How the waves that the hull makes act on it: by constant added mass and damping; or with memory, by "
        "those of all frequencies, where the vehicle's file has a table of them.",
    ),
]
StepOption = Annotated[
    float | None,
    typer.Option("--step", help="Step of the integrator in seconds.", show_default="by the vehicle's sheet"),
]
PlotOption = Annotated[
    Path | None,
    typer.Option(
        "--plot", help="File of the picture: .png, .svg or .pdf.", show_default="VEHICLE-MANOEUVRE.png"
    ),
]
NoPlotOption = Annotated[
    bool, typer.Option("--no-plot", help="Draw no picture. Matplotlib is then not needed.")
]
CsvOption = Annotated[
    Path | None, typer.Option("--csv", help="Write time, pose, velocity and commands into this file.")
]
JsonOption = Annotated[
    bool, typer.Option("--json", help="Print the figures as JSON, with null for those that were not reached.")
]
SideOption = Annotated[SideName, typer.Option("--side", help="Side to which the helm is put first.")]


@dataclass(frozen=True)
class Outputs:
    """The outputs of a result.

    Attributes:
        plot: of the picture; None for the default.
        no_plot: no picture.
        csv: of the series; None for none.
        json: the figures as JSON instead of a table.
    """

    plot: Path | None
    no_plot: bool
    csv: Path | None
    json: bool


@app.callback(
    epilog=examples(
        "dq-marine manoeuvre remus100 turning-circle",
        "dq-marine manoeuvre bluerov2_heavy zig-zag --angle 20",
        "dq-marine manoeuvre my_ship.toml stopping --order astern --json --csv stopping.csv",
        "dq-marine manoeuvre supply_vessel decay --motion heave --radiation memory",
        "dq-marine manoeuvre rexrov decay --help",
    )
)
def manoeuvre(
    ctx: typer.Context,
    vehicle: Annotated[str, typer.Argument(help="Catalogue name, or path of a TOML file.")],
) -> None:
    """Run a standard manoeuvre of a vehicle in still, deep water, and give its figures, a picture and the data.

    Throttle and helm are fractions of the vehicle's limits; helm is positive to starboard. A manoeuvre begins from a
    steady approach, the helm holding the heading; submerged vehicles hold their depth.
    """
    from dq_marine.vehicles import load_vehicle

    ctx.obj = (vehicle, load_vehicle(vehicle))


@app.command(
    "turning-circle", epilog=examples("dq-marine manoeuvre remus100 turning-circle --helm 0.5 --side port")
)
def turning_circle(
    ctx: typer.Context,
    helm: Annotated[float, typer.Option("--helm", help="Fraction of full helm, above 0 and up to 1.")] = 1.0,
    side: SideOption = SideName.STARBOARD,
    throttle: ThrottleOption = 1.0,
    actuation: ActuationOption = None,
    radiation: RadiationOption = RadiationName.CONSTANT,
    step: StepOption = None,
    plot: PlotOption = None,
    no_plot: NoPlotOption = False,
    csv: CsvOption = None,
    json: JsonOption = False,
) -> None:
    """Turning circle from a steady approach: advance, transfer, tactical diameter, steady radius, drift, roll.

    It turns by 540 degrees, or more until the turn is steady. The steady figures are those of the last half circle.
    """

    def run(vehicle: Vehicle, watch: Any) -> Result:
        from dq_marine.manoeuvres import Conditions
        from dq_marine.manoeuvres import turning_circle as turn

        conditions = Conditions(throttle, step, actuation, radiation.value)
        return turn(vehicle, helm=helm, side=side.value, conditions=conditions, watch=watch)

    _run_and_show(ctx, "turning-circle", run, Outputs(plot, no_plot, csv, json))


@app.command("zig-zag", epilog=examples("dq-marine manoeuvre bluerov2_heavy zig-zag --angle 20"))
def zig_zag(
    ctx: typer.Context,
    angle: Annotated[
        float, typer.Option("--angle", help="Heading change that reverses the helm, in degrees.")
    ] = 10.0,
    helm: Annotated[
        float | None,
        typer.Option(
            "--helm",
            help="Fraction of full helm.",
            show_default="as much rudder as the angle; 35 deg are full helm of vehicles without",
        ),
    ] = None,
    side: SideOption = SideName.STARBOARD,
    overshoots: Annotated[
        int, typer.Option("--overshoots", min=1, help="Number of overshoots to wait for.")
    ] = 4,
    throttle: ThrottleOption = 1.0,
    actuation: ActuationOption = None,
    radiation: RadiationOption = RadiationName.CONSTANT,
    step: StepOption = None,
    plot: PlotOption = None,
    no_plot: NoPlotOption = False,
    csv: CsvOption = None,
    json: JsonOption = False,
) -> None:
    """Zig-zag test, which reverses the helm at an angle of the heading: overshoots, initial turning time, period.

    10 degrees is the 10/10 test, 20 the 20/20.
    """

    def run(vehicle: Vehicle, watch: Any) -> Result:
        from dq_marine.manoeuvres import Conditions
        from dq_marine.manoeuvres import zig_zag as zig

        conditions = Conditions(throttle, step, actuation, radiation.value)
        return zig(
            vehicle,
            angle=math.radians(angle),
            helm=helm,
            side=side.value,
            overshoots=overshoots,
            conditions=conditions,
            watch=watch,
        )

    _run_and_show(ctx, "zig-zag", run, Outputs(plot, no_plot, csv, json))


@app.command("spiral", epilog=examples("dq-marine manoeuvre remus100 spiral --helm 0.5 --helms 8"))
def spiral(
    ctx: typer.Context,
    helm: Annotated[float, typer.Option("--helm", help="Largest helm, as a fraction of full helm.")] = 1.0,
    helms: Annotated[
        int, typer.Option("--helms", min=1, help="Number of helms to each side, besides 0.")
    ] = 6,
    throttle: ThrottleOption = 1.0,
    actuation: ActuationOption = None,
    radiation: RadiationOption = RadiationName.CONSTANT,
    step: StepOption = None,
    plot: PlotOption = None,
    no_plot: NoPlotOption = False,
    csv: CsvOption = None,
    json: JsonOption = False,
) -> None:
    """Spiral test: yaw rate for each helm, from starboard to port and back; a loop means unstable on course."""

    def run(vehicle: Vehicle, watch: Any) -> Result:
        from dq_marine.manoeuvres import Conditions
        from dq_marine.manoeuvres import spiral as turn_slowly

        conditions = Conditions(throttle, step, actuation, radiation.value)
        return turn_slowly(vehicle, helm=helm, helms=helms, conditions=conditions, watch=watch)

    _run_and_show(ctx, "spiral", run, Outputs(plot, no_plot, csv, json))


@app.command("acceleration", epilog=examples("dq-marine manoeuvre npsauv acceleration --throttle 0.5"))
def acceleration(
    ctx: typer.Context,
    throttle: Annotated[float, typer.Option("--throttle", help="Throttle, above 0 and up to 1.")] = 1.0,
    actuation: ActuationOption = None,
    radiation: RadiationOption = RadiationName.CONSTANT,
    step: StepOption = None,
    plot: PlotOption = None,
    no_plot: NoPlotOption = False,
    csv: CsvOption = None,
    json: JsonOption = False,
) -> None:
    """Acceleration from rest to top speed: times to 63 and 90 per cent of it, and the distance."""

    def run(vehicle: Vehicle, watch: Any) -> Result:
        from dq_marine.manoeuvres import Conditions
        from dq_marine.manoeuvres import acceleration as accelerate

        return accelerate(
            vehicle, conditions=Conditions(throttle, step, actuation, radiation.value), watch=watch
        )

    _run_and_show(ctx, "acceleration", run, Outputs(plot, no_plot, csv, json))


@app.command("stopping", epilog=examples("dq-marine manoeuvre remus100 stopping --order off"))
def stopping(
    ctx: typer.Context,
    order: Annotated[
        OrderName, typer.Option("--order", help="Full astern; or thrust off, down to 5 % of the speed.")
    ] = OrderName.ASTERN,
    throttle: ThrottleOption = 1.0,
    actuation: ActuationOption = None,
    radiation: RadiationOption = RadiationName.CONSTANT,
    step: StepOption = None,
    plot: PlotOption = None,
    no_plot: NoPlotOption = False,
    csv: CsvOption = None,
    json: JsonOption = False,
) -> None:
    """Stopping test from a steady approach, helm amidships: time, track reach, head reach."""

    def run(vehicle: Vehicle, watch: Any) -> Result:
        from dq_marine.manoeuvres import Conditions
        from dq_marine.manoeuvres import stopping as stop

        conditions = Conditions(throttle, step, actuation, radiation.value)
        return stop(vehicle, order=order.value, conditions=conditions, watch=watch)

    _run_and_show(ctx, "stopping", run, Outputs(plot, no_plot, csv, json))


@app.command("decay", epilog=examples("dq-marine manoeuvre rexrov decay --motion pitch --release 15"))
def decay(
    ctx: typer.Context,
    motion: Annotated[
        MotionName, typer.Option("--motion", help="Motion that is released.")
    ] = MotionName.ROLL,
    release: Annotated[
        float | None,
        typer.Option(
            "--release",
            help="Angle of the release in degrees, or heave in metres.",
            show_default="10, or length/20",
        ),
    ] = None,
    periods: Annotated[int, typer.Option("--periods", min=1, help="Number of periods to record.")] = 10,
    radiation: RadiationOption = RadiationName.CONSTANT,
    step: StepOption = None,
    plot: PlotOption = None,
    no_plot: NoPlotOption = False,
    csv: CsvOption = None,
    json: JsonOption = False,
) -> None:
    """Free decay from an angle or a heave: period and damping ratio, compared with linear theory."""

    def run(vehicle: Vehicle, watch: Any) -> Result:
        from dq_marine.manoeuvres import decay as release_it

        angle = release is not None and motion is not MotionName.HEAVE
        start = math.radians(release) if angle and release is not None else release
        return release_it(
            vehicle,
            motion=motion.value,
            release=start,
            periods=periods,
            step=step,
            radiation=radiation.value,
            watch=watch,
        )

    _run_and_show(ctx, "decay", run, Outputs(plot, no_plot, csv, json))


def _run_and_show(
    ctx: typer.Context, name: str, run: Callable[[Vehicle, Any], Result], outputs: Outputs
) -> None:
    """Run a manoeuvre and show its result; refuse first what could not be written after it."""
    given, vehicle = ctx.obj
    path = outputs.plot or Path(f"{Path(given).stem}-{name}.png")
    if not outputs.no_plot:
        from dq_marine.manoeuvres.canvas import check_picture_path  # imports matplotlib

        check_picture_path(path)
    with error_console.status(f"{name} of {escape(vehicle.name)}") as status:
        result = run(
            vehicle, lambda phase, time: status.update(f"{phase} of {escape(vehicle.name)}: {time:.4g} s")
        )
    if outputs.json:
        typer.echo(json_format.dumps(result.as_dict(), indent=2, allow_nan=False))
    else:
        from dq_marine.manoeuvres.table import result_table

        console.print(result_table(result))
        for note in result.notes:
            console.print(note, highlight=False)
    _write(result, path, outputs)


def _write(result: Result, path: Path, outputs: Outputs) -> None:
    """Write picture and series; say so apart from what is printed as data."""
    if not outputs.no_plot:
        from dq_marine.manoeuvres.views import save_plot

        save_plot(result, path)
        error_console.print(f"Wrote {path}", soft_wrap=True, highlight=False)
    if outputs.csv is not None:
        from dq_marine.manoeuvres.table import write_series

        write_series(result.series, outputs.csv)
        error_console.print(f"Wrote {outputs.csv}", soft_wrap=True, highlight=False)
