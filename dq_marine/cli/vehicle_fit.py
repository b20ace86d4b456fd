"""The command `dq-marine vehicles fit`: a vehicle's numbers from logged motion."""

from __future__ import annotations

import json as json_format
from pathlib import Path
from typing import Annotated

import typer

from dq_marine.cli.common import console, error_console, examples
from dq_marine.cli.keyword_values import read_value

EPILOG = examples(
    "dq-marine fly --vehicle bluerov2_heavy --current 0,0,0 --seconds 600 --trajectory run.csv",
    "dq-marine vehicles fit bluerov2_heavy --log run.csv --out fitted.toml",
    "dq-marine vehicles fit my_rov.toml --log pool.csv --fit linear,quadratic,gains --no-plot",
    "dq-marine vehicles fit my_rov.toml --log sea.csv --current 0.1,-0.2,0 --json",
    "dq-marine vehicles fit my_rov.toml --log sea.csv --fit quadratic,current",
    "dq-marine vehicles check fitted.toml",
)


def fit(
    vehicle: Annotated[
        str,
        typer.Argument(help="Catalogue name, or path of a TOML file, with a first estimate of all numbers."),
    ],
    log: Annotated[
        Path, typer.Option("--log", help="CSV file of the motion and of what drove it; see above.")
    ],
    groups: Annotated[
        str,
        typer.Option(
            "--fit",
            help="What is free: added_mass (its diagonal, couplings in proportion) or added_mass_full, linear, "
            "quadratic, couplings (lift), cross_flow, manoeuvring (the polynomials of an MMG hull), gains (of "
            "thrusters and fins), current (north and east, the same throughout).",
        ),
    ] = "added_mass,linear,quadratic,couplings,cross_flow,manoeuvring",
    out: Annotated[
        Path | None, typer.Option("--out", help="Vehicle file to write.", show_default="VEHICLE_fitted.toml")
    ] = None,
    plot: Annotated[
        Path | None,
        typer.Option(
            "--plot", help="Picture of the residuals (.png, .svg, .pdf).", show_default="that of --out, .png"
        ),
    ] = None,
    no_plot: Annotated[bool, typer.Option("--no-plot", help="Draw no picture.")] = False,
    bound: Annotated[
        float,
        typer.Option(
            "--bound",
            help="Largest relative standard error of a number that counts as told; others are held.",
        ),
    ] = 0.25,
    segment: Annotated[
        float | None,
        typer.Option(
            "--segment",
            help="Length of the pieces that are simulated, in seconds.",
            show_default="a thirtieth of the log, from 5 to 100",
        ),
    ] = None,
    step: Annotated[
        float | None,
        typer.Option(
            "--step", help="Largest step of the integrator in seconds.", show_default="by the vehicle's sheet"
        ),
    ] = None,
    current: Annotated[
        str,
        typer.Option(
            "--current",
            help="Velocity of the water in m/s: north,east,down; with --fit current, what the search begins from.",
        ),
    ] = "0,0,0",
    json: Annotated[bool, typer.Option("--json", help="Print JSON instead of a table.")] = False,
    force: Annotated[bool, typer.Option("--force", help="Replace existing files.")] = False,
) -> None:
    """Fit a vehicle's numbers to a log of its motion, and write it as a vehicle file.

    The log has a header with units: time_s; roll_deg, pitch_deg, heading_deg (or q_scalar, q_x, q_y, q_z); u_m_s,
    v_m_s, w_m_s over ground in the body frame; if you have them p_rad_s, q_rad_s, r_rad_s, depth_m, north_m, east_m;
    and what drove the vehicle, held from its row to the next: X_N, Y_N, Z_N, K_N_m, M_N_m, N_N_m, or command_NAME of
    each channel, with its unit at the end. A file of dq-marine fly --trajectory is such a log. Empty fields are sensors
    without a reading. Let the vehicle move in all the ways whose numbers you want, ten minutes or so.

    What the log cannot tell is said by name and held as the file has it. What is zero in the file stays zero.
    """
    from dq_marine.identification import Conditions, fit_vehicle, read_log
    from dq_marine.identification.fitted_file import check_vehicle_path, write_fitted
    from dq_marine.identification.table import as_dict, fit_table
    from dq_marine.vehicles import load_vehicle

    target = out or Path(f"{Path(vehicle).stem}_fitted.toml")
    conditions = Conditions(
        groups=tuple(part.strip() for part in groups.split(",")),
        bound=bound,
        segment=segment,
        step=step,
        current=read_value(current, option="--current"),
    )
    check_vehicle_path(target, force=force)
    picture = None if no_plot else plot or target.with_suffix(".png")
    if picture is not None:
        from dq_marine.identification.residual_plot import check_plot_path

        check_plot_path(picture)
    nominal = load_vehicle(vehicle)
    with error_console.status("reading") as status:
        found = fit_vehicle(nominal, read_log(log, nominal), conditions, status.update)
    if json:
        typer.echo(json_format.dumps(as_dict(found), indent=2, allow_nan=False))
    else:
        console.print(fit_table(found))
        for note in found.notes:
            console.print(f"Note: {note}", highlight=False, markup=False)
    write_fitted(found, target)
    error_console.print(f"Wrote {target}", soft_wrap=True, highlight=False)
    if picture is not None:
        from dq_marine.identification.residual_plot import save_residuals

        save_residuals(found, picture)
        error_console.print(f"Wrote {picture}", soft_wrap=True, highlight=False)
