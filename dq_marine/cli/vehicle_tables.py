"""Tables of vehicles for the terminal."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from rich.box import SIMPLE
from rich.table import Table
from rich.text import Text

from dq_marine.randomisation import Spread
from dq_marine.vehicles import Sheet, Vehicle, vehicle_sheet
from dq_marine.vehicles.model import MOTIONS

ROTATIONS = MOTIONS[3:]


def catalogue_table(vehicles: Mapping[str, Vehicle]) -> Table:
    """Return one row for each vehicle, by its catalogue name."""
    table = Table(
        box=SIMPLE,
        collapse_padding=True,
        pad_edge=False,
        caption="W - B: weight less buoyancy, positive sinks. Actuated: forces and moments that an action drives. "
        "Coupling: largest |M_ij| / sqrt(M_ii M_jj). Munk: growth rate at 1 m/s ahead, undamped.",
    )
    table.add_column("name", no_wrap=True)
    for heading in (
        "mass\n[kg]",
        "length\n[m]",
        "W - B\n[N]",
        "actu-\nated",
        "coup-\nling",
        "roll,\npitch [s]",
        "Munk\n[1/s]",
    ):
        table.add_column(Text(heading), justify="right", no_wrap=True)
    for name, vehicle in vehicles.items():
        sheet = vehicle_sheet(vehicle)
        table.add_row(
            name,
            f"{sheet.dry_mass:.4g}",
            f"{vehicle.dimensions.length:.3g}",
            _net_weight(sheet),
            _letters(vehicle),
            f"{sheet.coupling:.2f}",
            f"{_number(sheet.roll_period)}, {_number(sheet.pitch_period)}",
            _number(sheet.munk_growth_rate),
        )
    return table


def sheet_table(sheet: Sheet) -> Table:
    """Return all of a sheet: what, how much, in which unit."""
    table = Table(title=Text(sheet.name), caption=Text(sheet.description), show_header=False)
    table.add_column(no_wrap=True)
    table.add_column()
    for what, value in (*_masses(sheet), *_motions(sheet), *_steps(sheet)):
        table.add_row(Text(what), Text(value))
    return table


def spread_table(title: str, spreads: Sequence[Spread]) -> Table:
    """Return how far drawn vehicles spread, a row for each number."""
    table = Table(title=Text(title), box=SIMPLE, pad_edge=False)
    table.add_column("")
    for heading in ("nominal", "least", "mean", "largest"):
        table.add_column(heading, justify="right", no_wrap=True)
    table.add_column("unit", no_wrap=True)
    for spread in spreads:
        values = (spread.nominal, spread.least, spread.mean, spread.largest)
        table.add_row(spread.name, *(_number(value) for value in values), Text(spread.unit))
    return table


def _masses(sheet: Sheet) -> list[tuple[str, str]]:
    coupled = f", {' and '.join(sheet.coupled)}" if sheet.coupled else ""
    conditions = f"{sheet.condition_number:.4g}, {sheet.unit_free_condition_number:.3g}"
    rows = [
        ("dry mass", f"{sheet.dry_mass:g} kg"),
        ("weight, buoyancy", f"{sheet.weight:.5g} N, {sheet.buoyancy:.5g} N"),
        ("weight less buoyancy: positive sinks", f"{_net_weight(sheet)} N"),
        *(
            (f"added mass in {motion}", _with_unit(sheet.added_mass, motion, "kg", "kg m^2"))
            for motion in MOTIONS
        ),
        ("condition number of M: SI, unit-free", conditions),
        ("largest coupling |M_ij| / sqrt(M_ii M_jj)", f"{sheet.coupling:.3g}{coupled}"),
    ]
    if sheet.added_mass_asymmetry > 0.0:
        rows.append(
            ("asymmetry of M_A as published, removed", f"{sheet.added_mass_asymmetry:.2g} in these units")
        )
    return rows


def _motions(sheet: Sheet) -> list[tuple[str, str]]:
    floats = math.isfinite(sheet.heave_period)
    heave = [("natural period of heave", f"{_number(sheet.heave_period)} s")] if floats else []
    own = sheet.service_speed
    service = [] if own is None else [("service speed, by its own propeller", f"{own:g} m/s")]
    return [
        *heave,
        *service,
        ("natural period of roll, pitch", f"{_number(sheet.roll_period)} s, {_number(sheet.pitch_period)} s"),
        *((f"terminal speed in {motion}", _terminal(sheet, motion)) for motion in MOTIONS),
    ]


def _steps(sheet: Sheet) -> list[tuple[str, str]]:
    ahead = f"at {sheet.speed:g} m/s ahead"
    return [
        (f"Munk growth rate {ahead}, undamped", f"{_number(sheet.munk_growth_rate)} 1/s"),
        ("largest step for the restoring forces", f"{_number(sheet.restoring_step)} s"),
        (f"largest step for translation {ahead}", f"{_number(sheet.translation_step)} s"),
        ("largest step: a tenth of it is accurate", f"{_number(sheet.largest_step)} s"),
        *(("the file's numbers hold for", line) for line in sheet.validity or ("not known",)),
        *(("radiation memory", line) for line in sheet.radiation_memory),
    ]


def _terminal(sheet: Sheet, motion: str) -> str:
    speed = sheet.terminal_speed[motion]
    if speed == 0.0:
        return "not actuated"
    if math.isinf(speed):
        return "not damped"
    helped = motion == "surge" and sheet.service_speed is not None
    return _with_unit(sheet.terminal_speed, motion, "m/s", "rad/s") + (
        ", the propeller helping" if helped else ""
    )


def _with_unit(values: Mapping[str, float], motion: str, linear: str, angular: str) -> str:
    return f"{values[motion]:.4g} {angular if motion in ROTATIONS else linear}"


def _net_weight(sheet: Sheet) -> str:
    """Return W - B, without the round-off of a neutral vehicle."""
    net = sheet.weight - sheet.buoyancy
    return "0" if abs(net) < 5e-9 * sheet.weight else f"{net:+.3g}"


def _letters(vehicle: Vehicle) -> str:
    """Return which axes an action drives, as in `XYZKMN`, the letters of forces and moments."""
    letters = zip("XYZKMN", vehicle.wrench_limits, strict=True)
    return "".join(letter if limit > 0.0 else "-" for letter, limit in letters)


def _number(value: float) -> str:
    return "none" if math.isinf(value) else f"{value:.3g}"
