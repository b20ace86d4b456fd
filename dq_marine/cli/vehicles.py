"""The commands `dq-marine vehicles ...`: list, check, sheet, show, export, from-mesh, randomise, fit."""

from __future__ import annotations

import json as json_format
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.markup import escape

from dq_marine.cli import vehicle_fit
from dq_marine.cli.common import HELP_OPTIONS, console, examples
from dq_marine.cli.from_mesh import EXAMPLES, from_mesh

if TYPE_CHECKING:
    from dq_marine.vehicles import Sheet

app = typer.Typer(rich_markup_mode="rich", context_settings=HELP_OPTIONS)

JsonOption = Annotated[bool, typer.Option("--json", help="Print JSON, with null for infinite values.")]
SpeedOption = Annotated[
    float, typer.Option("--speed", help="Speed through the water in m/s, for growth rate and step.")
]
VehicleArgument = Annotated[str, typer.Argument(help="Catalogue name, or path of a TOML file.")]


@app.callback(
    invoke_without_command=True,
    epilog=examples(
        "dq-marine vehicles",
        "dq-marine vehicles sheet rexrov",
        "dq-marine vehicles show remus100 --html remus100.html",
        "dq-marine vehicles export bluerov2_heavy my_vehicle.toml",
        "dq-marine vehicles check my_vehicle.toml",
        "dq-marine vehicles from-mesh hull.stl --mass 31 --unit mm",
        "dq-marine vehicles randomise bluerov2_heavy",
        "dq-marine vehicles fit my_vehicle.toml --log run.csv --out fitted.toml",
    ),
)
def vehicles(ctx: typer.Context) -> None:
    """List the vehicles of the catalogue; show, vary, check, export or fit one, or make one from a mesh."""
    if ctx.invoked_subcommand is not None:
        return
    from dq_marine.cli.vehicle_tables import catalogue_table
    from dq_marine.vehicles import load_vehicle, vehicle_names
    from dq_marine.vehicles.variants import variant_names

    console.print(catalogue_table({name: load_vehicle(name) for name in vehicle_names()}))
    for name in variant_names():
        console.print(f"Variant {name}: {load_vehicle(name).name}", highlight=False, markup=False)


@app.command(epilog=examples("dq-marine vehicles check my_vehicle.toml"))
def check(
    file: Annotated[Path, typer.Argument(help="A vehicle file (TOML).")],
    speed: SpeedOption = 1.0,
    json: JsonOption = False,
) -> None:
    """Check a vehicle file (fields, units, physics) and print the vehicle's sheet."""
    from dq_marine.vehicles import load_vehicle, vehicle_sheet

    vehicle = load_vehicle(file)
    sheet = vehicle_sheet(vehicle, speed=speed)
    if not json:
        console.print(
            f"{escape(str(file))} is valid: {escape(vehicle.name)}, {vehicle.rigid_body.mass:g} kg",
            highlight=False,
            soft_wrap=True,
        )
    _print_sheet(sheet, json)


@app.command(
    epilog=examples("dq-marine vehicles sheet npsauv", "dq-marine vehicles sheet remus100 --speed 2.5 --json")
)
def sheet(vehicle: VehicleArgument, speed: SpeedOption = 1.0, json: JsonOption = False) -> None:
    """Print a vehicle's key numbers: masses, coupling, natural periods, speeds, stability, largest step."""
    from dq_marine.vehicles import load_vehicle, vehicle_sheet

    _print_sheet(vehicle_sheet(load_vehicle(vehicle), speed=speed), json)


@app.command(
    epilog=examples("dq-marine vehicles show rexrov", "dq-marine vehicles show npsauv --html npsauv.html")
)
def show(
    vehicle: VehicleArgument,
    html: Annotated[
        Path | None,
        typer.Option("--html", help="Write a page into this file instead; it needs no server."),
    ] = None,
) -> None:
    """Show a vehicle in the browser."""
    from dq_marine.envs.core.view import open_page, shape_of
    from dq_marine.vehicles import load_vehicle
    from dq_marine.viewer.replay import save_replay
    from dq_marine.viewer.snapshot import at_rest

    loaded = load_vehicle(vehicle)
    shape = shape_of(loaded)
    still = at_rest(depth=2.0 * shape.size if loaded.hydrostatics is None else loaded.equilibrium_depth)
    if html is not None:
        save_replay(html, [still], shape, title=loaded.name)
        console.print(f"Wrote {html}", soft_wrap=True)
        return
    with open_page(shape, loaded.name) as page:
        page.draw(still)
        console.print("Ctrl-C closes the page.")
        wait_for_interrupt()


@app.command(
    epilog=examples(
        "dq-marine vehicles export bluerov2_heavy",
        "dq-marine vehicles export supply_vessel ships/mine.toml",
        "dq-marine vehicles check ships/mine.toml",
        "dq-marine fly --vehicle my_bluerov2_heavy.toml --live",
    )
)
def export(
    name: Annotated[str, typer.Argument(help="A catalogue name.")],
    file: Annotated[
        Path | None, typer.Argument(help="File to write, ending in .toml.", show_default="my_NAME.toml")
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace existing files.")] = False,
) -> None:
    """Copy a vehicle of the catalogue into a file, as a start for your own, with its comments, sources and tables."""
    from dq_marine.vehicles.export import export_vehicle

    target = Path(f"my_{name}.toml") if file is None else file
    for written in export_vehicle(name, target, force=force):
        console.print(f"Wrote {written}", soft_wrap=True, highlight=False)
    console.print(f"Next: dq-marine vehicles check {target}", soft_wrap=True, highlight=False)


@app.command(
    epilog=examples(
        "dq-marine vehicles randomise bluerov2_heavy",
        "dq-marine vehicles randomise remus100 --file my_ranges.toml --samples 1000",
        "dq-marine vehicles randomise rexrov --file published --seed 3 --json",
    )
)
def randomise(
    vehicle: VehicleArgument,
    samples: Annotated[int, typer.Option("--samples", min=1, help="Number of vehicles to draw.")] = 100,
    file: Annotated[
        str,
        typer.Option(
            "--file",
            help="Distributions: 'default' (ballasted and trimmed), 'published' (each number drawn independently), "
            "or the path of your own TOML file.",
        ),
    ] = "default",
    seed: Annotated[int, typer.Option("--seed", min=0, help="Seed of the draws.")] = 0,
    json: JsonOption = False,
) -> None:
    """Draw random variants of a vehicle, for domain randomisation, and print their spread.

    A policy that has learned on many vehicles is less surprised by the real one. The file says for mass, inertia,
    buoyancy, added mass, damping and actuators from which distribution a factor or an offset is
    drawn; what it leaves out stays. Every vehicle drawn is physical: its mass matrix positive definite, its damping
    dissipative.

    In Python the same vehicles fly, another one in each episode, with
    gym.make("dq_marine/StationKeeping-v0", randomise="default", vehicle_pool=100, vehicle_seed=0).
    """
    from dq_marine.cli.vehicle_tables import spread_table
    from dq_marine.randomisation import Randomisation, spread_of
    from dq_marine.vehicles import load_vehicle

    nominal, randomisation = load_vehicle(vehicle), Randomisation.load(file)
    spreads = spread_of(nominal, randomisation.pool(nominal, samples, seed))
    if json:
        typer.echo(json_format.dumps([spread.as_dict() for spread in spreads], indent=2, allow_nan=False))
        return
    console.print(spread_table(f"{nominal.name}: {samples} drawn from {file}, seed {seed}", spreads))


app.command(epilog=vehicle_fit.EPILOG)(vehicle_fit.fit)
app.command("from-mesh", epilog=examples(*EXAMPLES))(from_mesh)


def wait_for_interrupt() -> None:
    """Return when the user presses Ctrl-C."""
    from threading import Event

    try:
        Event().wait()
    except KeyboardInterrupt:
        return


def _print_sheet(sheet: Sheet, json: bool) -> None:
    if json:
        typer.echo(json_format.dumps(sheet.as_dict(), indent=2, allow_nan=False))
        return
    from dq_marine.cli.vehicle_tables import sheet_table

    console.print(sheet_table(sheet))
