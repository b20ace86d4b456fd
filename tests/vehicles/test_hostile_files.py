"""Vehicle files that no honest hand wrote: refused with a word on what is wrong, and never interpreted."""

import os
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from dq_marine.cli.main import app
from dq_marine.errors import InvalidInputError, VehicleFileError
from dq_marine.randomisation import Randomisation
from dq_marine.vehicles import load_vehicle
from dq_marine.vehicles.loading import catalogue_file


@pytest.fixture
def changed(tmp_path: Path):
    """A function that writes a catalogue vehicle's file with a line changed, or added at the top."""

    def write(line: str, new: str, name: str = "bluerov2_heavy") -> Path:
        text = catalogue_file(name).read_text(encoding="utf-8")
        assert line in text
        file = tmp_path / "changed.toml"
        file.write_text(text.replace(line, new, 1), encoding="utf-8")
        return file

    return write


def test_a_thrust_direction_of_any_length_is_only_a_direction(changed):
    """Squares of its components would over- or underflow."""
    usual = load_vehicle("otter").thrusters[0].unit_direction
    for size in ("1e10", "1e-150"):
        file = changed("direction = [1.0, 0.0, 0.0]", f"direction = [{size}, 0.0, 0.0]", "otter")
        assert np.allclose(load_vehicle(file).thrusters[0].unit_direction, usual)


@pytest.mark.parametrize("number", ["1e200", "1e308", "1e21"])
def test_numbers_beyond_anything_that_floats_are_refused(changed, number):
    with pytest.raises(VehicleFileError, match=r"no ship has.*check exponent and unit"):
        load_vehicle(changed("\nmass = ", f"\nmass = {number} # "))


@pytest.mark.parametrize("line", ["\nvolume = ", "\nlength = ", "\nmass = ", "\nwater_density = "])
def test_numbers_whose_products_vanish_are_refused(changed, line):
    """A quotient by such a product was a ZeroDivisionError."""
    with pytest.raises(VehicleFileError, match=r"no ship has a number below 1e-20.*check exponent and unit"):
        load_vehicle(changed(line, f"{line}1e-310 # "))


def test_control_characters_are_refused(changed):
    with pytest.raises(VehicleFileError, match="control characters"):
        load_vehicle(changed('name = "', r'name = "\u001b[31m'))


def test_markup_is_shown_as_it_is(changed):
    file = changed('name = "', 'name = "[red]no colour[/red] [/nor an error] ')
    for command in ("check", "sheet"):
        result = CliRunner().invoke(app, ["vehicles", command, str(file)])
        assert result.exit_code == 0, result.output
        assert "[red]no colour[/red] [/nor an error]" in result.output


@pytest.mark.parametrize(
    "nested", ["[" * 5000 + "]" * 5000, "{a=" * 2000 + "1" + "}" * 2000], ids=["lists", "tables"]
)
def test_deep_nesting_is_refused(tmp_path, nested):
    file = tmp_path / "deep.toml"
    file.write_text(f"x = {nested}")
    with pytest.raises(VehicleFileError, match="not a vehicle file"):
        load_vehicle(file)
    with pytest.raises(InvalidInputError, match="not a TOML file"):
        Randomisation.load(file)


@pytest.mark.parametrize("beside", ["/dev/zero", "pipe", "wide.csv", "nowhere.csv", "."])
def test_radiation_files_are_regular_files_of_a_sane_content(changed, tmp_path, beside):
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "wide.csv").write_text(
        "frequency,force,motion,added_mass,damping\n" + "1" * 2**20 + ",surge,surge,1,1\n"
    )
    with pytest.raises(VehicleFileError, match=r"radiation = .* cannot be read"):
        load_vehicle(changed('name = "', f'radiation = "{beside}"\nname = "'))


def test_a_huge_file_is_not_read(tmp_path):
    file = tmp_path / "huge.toml"
    with file.open("wb") as content:
        content.truncate(2**30)
    with pytest.raises(InvalidInputError, match=r"1,073,741,824 bytes; give a file of at most"):
        load_vehicle(file)


@pytest.mark.parametrize("path", ["~nosuchuser/x.toml", "x" * 5000, "a\x00b", "\udcff"])
def test_paths_that_cannot_be_are_refused(path):
    for load in (load_vehicle, Randomisation.load):
        with pytest.raises(InvalidInputError):
            load(path)
