"""The command `dq-marine sea`: a sea in numbers and as a picture."""

from __future__ import annotations

import json as json_format
import math
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from dq_marine.cli.common import console, examples
from dq_marine.errors import InvalidInputError

if TYPE_CHECKING:
    from dq_marine.physics.weather import Sea, Spectrum

EXAMPLES = examples(
    "dq-marine sea --hs 2 --tp 8 --plot sea.png",
    "dq-marine sea --hs 2 --tp 8 --gamma 5 --seed 3 --seconds 10000",
    "dq-marine sea --spectrum pierson-moskowitz --wind-speed 15",
    "dq-marine sea --spectrum ittc --hs 3 --t1 7 --water-depth 20 --json",
)


class SpectrumName(StrEnum):
    """What `--spectrum` takes."""

    JONSWAP = "jonswap"
    PIERSON_MOSKOWITZ = "pierson-moskowitz"
    ITTC = "ittc"


def sea(
    spectrum: Annotated[
        SpectrumName,
        typer.Option(
            "--spectrum",
            help="jonswap: a growing sea, by --hs and --tp. pierson-moskowitz: a fully developed sea, by --wind-speed, "
            "or by --hs and --tp. ittc: the same, by --hs and --t1.",
        ),
    ] = SpectrumName.JONSWAP,
    hs: Annotated[
        float | None, typer.Option("--hs", help="Significant height in m: 4 standard deviations.")
    ] = None,
    tp: Annotated[float | None, typer.Option("--tp", help="Period of the spectrum's peak in s.")] = None,
    t1: Annotated[float | None, typer.Option("--t1", help="Mean period in s.")] = None,
    wind_speed: Annotated[
        float | None,
        typer.Option(
            "--wind-speed", help="Wind speed in m/s at a height of 19.5 m, for a fully developed sea."
        ),
    ] = None,
    gamma: Annotated[
        float, typer.Option("--gamma", help="Peak enhancement factor of the Jonswap spectrum, 1 to 20.")
    ] = 3.3,
    water_depth: Annotated[
        float | None, typer.Option("--water-depth", help="Depth of the water in m.", show_default="deep")
    ] = None,
    components: Annotated[int, typer.Option("--components", help="Number of wave components.")] = 80,
    seed: Annotated[int, typer.Option("--seed", min=0, help="Seed of frequencies and phases.")] = 0,
    seconds: Annotated[
        float, typer.Option("--seconds", help="Length of the simulated record in s.")
    ] = 3600.0,
    plot: Annotated[
        Path | None,
        typer.Option("--plot", help="Draw spectrum and record into this file (.png, .svg, .pdf)."),
    ] = None,
    json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
) -> None:
    """Print heights, periods, lengths and steepness of a sea, and of a simulated record of it.

    The record has --components waves with random phases, as in `Scene(weather=[Sea(...)])`. Its height differs from
    that of the spectrum, because it is finite.
    """
    from dq_marine.checks import finite_number
    from dq_marine.physics.weather import Sea

    finite_number("seconds", seconds, above=0.0)
    chosen = requested_spectrum(spectrum, hs=hs, tp=tp, t1=t1, wind_speed=wind_speed, gamma=gamma)
    made = Sea(chosen, components=components, seed=seed, depth=water_depth)
    numbers = sea_numbers(made, seconds)
    if json:
        typer.echo(json_format.dumps(numbers, indent=2, allow_nan=False))
    else:
        for name, value in numbers.items():
            console.print(f"{name:<28} {value:.4g}", highlight=False, markup=False)
    if plot is not None:
        from dq_marine.cli.sea_plot import save_sea_plot

        save_sea_plot(made, plot, seconds=seconds)
        if not json:
            console.print(f"Wrote {plot}", soft_wrap=True)


def requested_spectrum(
    name: SpectrumName,
    *,
    hs: float | None,
    tp: float | None,
    t1: float | None,
    wind_speed: float | None,
    gamma: float,
) -> Spectrum:
    """Return the spectrum that the options ask for.

    Raises:
        InvalidInputError: an option is missing, or one is given that the spectrum does not take.
    """
    from dq_marine.physics.weather import Jonswap, ModifiedPiersonMoskowitz, PiersonMoskowitz

    given = {"--hs": hs, "--tp": tp, "--t1": t1, "--wind-speed": wind_speed}
    by_wind = name is SpectrumName.PIERSON_MOSKOWITZ and wind_speed is not None
    wanted = ("--wind-speed",) if by_wind else ("--hs", "--t1" if name is SpectrumName.ITTC else "--tp")
    missing = [option for option in wanted if given[option] is None]
    extra = [option for option, value in given.items() if value is not None and option not in wanted]
    if missing or extra:
        wrong = f"{', '.join(missing)} is missing" if missing else f"{', '.join(extra)} is not asked for"
        raise InvalidInputError(f"--spectrum {name.value}: {wrong}; give {' and '.join(wanted)}")
    numbers = [value for value in (given[option] for option in wanted) if value is not None]
    if by_wind:
        return PiersonMoskowitz(*numbers)
    height, period = numbers
    if name is SpectrumName.ITTC:
        return ModifiedPiersonMoskowitz(height, period)
    return Jonswap(height, period, gamma if name is SpectrumName.JONSWAP else 1.0)


def sea_numbers(sea: Sea, seconds: float) -> dict[str, float]:
    """Return the numbers of a sea and of a record of it, each with its unit in the name."""
    import numpy as np

    from dq_marine.physics.waves.dispersion import wave_numbers

    spectrum = sea.spectrum
    length = 2.0 * math.pi / float(wave_numbers(spectrum.peak_frequency, sea.depth, sea.gravity))
    record = sea.elevation(np.arange(0.0, seconds, record_step(sea)))
    return {
        "significant height [m]": spectrum.significant_height,
        "peak period [s]": spectrum.peak_period,
        "mean period T1 [s]": spectrum.mean_of_periods,
        "zero-crossing period [s]": spectrum.zero_crossing_period,
        "wave length at peak [m]": length,
        "steepness Hs/length": spectrum.significant_height / length,
        "record: 4 std [m]": 4.0 * float(record.std()),
        "record: highest crest [m]": float(record.max()),
        "record: deepest trough [m]": float(record.min()),
    }


def record_step(sea: Sea) -> float:
    """Return the time between samples of a record [s]: twenty in a wave of the peak."""
    return sea.spectrum.peak_period / 20.0
