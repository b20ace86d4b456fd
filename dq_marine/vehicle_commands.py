"""The commands `dq-marine vehicles ...`: list, check, sheet, show, randomise."""

from __future__ import annotations

import json as json_format
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from dq_marine.command_basics import HELP_OPTIONS, console, examples

if TYPE_CHECKING:
    from dq_marine.vehicles import Sheet

app = typer.Typer(rich_markup_mode="rich", context_settings=HELP_OPTIONS)

JsonOption = Annotated[bool, typer.Option("--json", help="As JSON; what is infinite is null.")]
SpeedOption = Annotated[
    float, typer.Option("--speed", help="Through the water, in m/s, for growth rate and step.")
]
VehicleArgument = Annotated[str, typer.Argument(help="Catalogue name, or path of a TOML file.")]


@app.callback(
    invoke_without_command=True,
    epilog=examples(
        "dq-marine vehicles",
        "dq-marine vehicles sheet rexrov",
        "dq-marine vehicles show remus100 --html remus100.html",
        "dq-marine vehicles check my_vehicle.toml",
        "dq-marine vehicles randomise bluerov2_heavy",
    ),
)
def vehicles(ctx: typer.Context) -> None:
    """List the catalogue's vehicles; print a vehicle's sheet, look at it, vary it, or check a vehicle file."""
    if ctx.invoked_subcommand is not None:
        return
    from dq_marine.vehicle_tables import catalogue_table
    from dq_marine.vehicles import load_vehicle, vehicle_names

    console.print(catalogue_table({name: load_vehicle(name) for name in vehicle_names()}))


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
            f"{file} is valid: {vehicle.name}, {vehicle.rigid_body.mass:g} kg",
            highlight=False,
            soft_wrap=True,
        )
    _print_sheet(sheet, json)


@app.command(
    epilog=examples("dq-marine vehicles sheet npsauv", "dq-marine vehicles sheet remus100 --speed 2.5 --json")
)
def sheet(vehicle: VehicleArgument, speed: SpeedOption = 1.0, json: JsonOption = False) -> None:
    """Print how a vehicle will behave: masses, coupling, natural periods, speeds, stability, largest step."""
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
    """Look at a vehicle in the browser."""
    from dq_marine.envs.view import open_page, shape_of
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
    with open_page(shape) as page:
        page.draw(still)
        console.print("Ctrl-C closes the page.")
        wait_for_interrupt()


@app.command(
    epilog=examples(
        "dq-marine vehicles randomise bluerov2_heavy",
        "dq-marine vehicles randomise remus100 --file my_ranges.toml --samples 1000",
        "dq-marine vehicles randomise rexrov --file published --seed 3 --json",
    )
)
def randomise(
    vehicle: VehicleArgument,
    samples: Annotated[int, typer.Option("--samples", min=1, help="How many vehicles to draw.")] = 100,
    file: Annotated[
        str,
        typer.Option(
            "--file",
            help="What is drawn: 'default' (ballasted and trimmed), 'published' (each number apart from the others), "
            "or the path of a TOML file of your own.",
        ),
    ] = "default",
    seed: Annotated[
        int, typer.Option("--seed", min=0, help="Of the draws; the same one gives the same.")
    ] = 0,
    json: JsonOption = False,
) -> None:
    """Draw vehicles like one, for domain randomisation, and print how far they spread.

    A policy that has learned on many vehicles is less surprised by the real one. The file says for mass, inertia,
    buoyancy, added mass, damping and actuators from which distribution a factor or an offset is
    drawn; what it leaves out stays. Every vehicle drawn is physical: its mass matrix positive definite, its damping
    dissipative.

    In Python the same vehicles fly, another one in each episode, with
    gym.make("dq_marine/StationKeeping-v0", randomise="default", vehicle_pool=100, vehicle_seed=0).
    """
    from dq_marine.randomisation import Randomisation, spread_of
    from dq_marine.vehicle_tables import spread_table
    from dq_marine.vehicles import load_vehicle

    nominal, randomisation = load_vehicle(vehicle), Randomisation.load(file)
    spreads = spread_of(nominal, randomisation.pool(nominal, samples, seed))
    if json:
        typer.echo(json_format.dumps([spread.as_dict() for spread in spreads], indent=2, allow_nan=False))
        return
    console.print(spread_table(f"{nominal.name}: {samples} drawn from {file}, seed {seed}", spreads))


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
    from dq_marine.vehicle_tables import sheet_table

    console.print(sheet_table(sheet))
