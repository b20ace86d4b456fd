"""Doors of files of numbers: transfer functions and radiation."""

from __future__ import annotations

import json
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

import dq_marine
from dq_marine.vehicles import load_vehicle
from hostile.texts import changed_bytes, changed_table
from hostile.values import Rng, spoilt

HEADINGS = [0.0, 0.785, 1.571, 2.356, 3.142, 3.927, 4.712, 5.498]
"""All around the hull [rad]."""

CATALOGUE = Path(dq_marine.__file__).parent / "vehicles" / "catalogue"


def force_table(rng: Rng) -> str:
    """Transfer functions of a hull as a CSV file has them."""
    lines = ["frequency,heading,axis,amplitude,phase"]
    for frequency in (0.3, 0.6, 0.9):
        for heading in HEADINGS:
            lines += [
                f"{frequency},{heading},{axis},{rng.uniform(0.0, 1e4):.6g},{rng.uniform(-3.0, 3.0):.6g}"
                for axis in "XYZKMN"
            ]
    return "\n".join(lines)


def force_entries(rng: Rng) -> dict[str, Any]:
    """The same as a JSON or NPZ file has them."""
    transfer = rng.normal(size=(2, 3, len(HEADINGS), 6)) * 1e3
    return {
        "frequencies": [0.3, 0.6, 0.9],
        "headings": HEADINGS,
        "real": transfer[0].tolist(),
        "imaginary": transfer[1].tolist(),
    }


def drawn_force_file(rng: Rng) -> Callable[[], Any]:
    """A file of transfer functions, gone wrong or not, and a sea that acts by them."""
    ending = (".csv", ".csv", ".json", ".npz")[rng.integers(4)]
    folder = Path(tempfile.mkdtemp())
    file = folder / f"hull{ending}"
    if ending == ".csv":
        text = force_table(rng)
        for _ in range(rng.integers(3)):
            text = changed_table(rng, text)
        file.write_text(text, encoding="utf-8", errors="surrogatepass")
    elif ending == ".json":
        entries = spoilt(rng, force_entries(rng))
        file.write_text(json.dumps(entries, default=lambda value: type(value).__name__, skipkeys=True))
    else:
        with file.open("wb") as opened:
            np.savez(opened, **{name: np.array(value) for name, value in force_entries(rng).items()})
        if rng.integers(3):
            file.write_bytes(changed_bytes(rng, file.read_bytes()))

    def load() -> Any:
        try:
            rao = dq_marine.read_force_rao(file)
        finally:
            file.unlink()
            folder.rmdir()
        sea = dq_marine.Sea(dq_marine.Jonswap(1.0, 7.0), components=5, seed=1)
        return dq_marine.Scene("osv83", weather=[dq_marine.WaveLoads(sea, rao)])

    return load


def drawn_radiation_file(rng: Rng) -> Callable[[], Any]:
    """A vehicle of the catalogue beside whose file stands a table of radiation that has gone wrong, or not."""
    text = (CATALOGUE / "supply_vessel_radiation.csv").read_text(encoding="utf-8")
    for _ in range(rng.integers(3)):
        text = changed_table(rng, text)
    folder = Path(tempfile.mkdtemp())
    (folder / "vessel.toml").write_bytes((CATALOGUE / "supply_vessel.toml").read_bytes())
    (folder / "supply_vessel_radiation.csv").write_text(text, encoding="utf-8", errors="surrogatepass")

    def load() -> Any:
        try:
            vessel = load_vehicle(folder / "vessel.toml")
        finally:
            for file in folder.iterdir():
                file.unlink()
            folder.rmdir()
        sea = dq_marine.Sea(dq_marine.Jonswap(1.0, 7.0), components=5, seed=1)
        return dq_marine.Scene(vessel, weather=[dq_marine.WaveLoads(sea)])

    return load
