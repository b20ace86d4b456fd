"""Vehicles written out of the catalogue: the same vehicles, their comments and sources kept."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from dq_marine.errors import InvalidInputError
from dq_marine.vehicles import load_vehicle, vehicle_names
from dq_marine.vehicles.export import export_vehicle
from dq_marine.vehicles.loading import catalogue_file


@pytest.mark.parametrize("name", vehicle_names())
def test_what_is_exported_is_the_vehicle_under_another_name(name: str, tmp_path: Path) -> None:
    written = export_vehicle(name, tmp_path / "mine.toml")
    assert sorted(written) == sorted(tmp_path.iterdir())
    exported, original = load_vehicle(written[0]), load_vehicle(name)
    assert exported.name == f"My {original.name}"
    same = {"name": original.name}
    assert repr(exported.model_copy(update=same)) == repr(original)
    text, source = (path.read_text(encoding="utf-8") for path in (written[0], catalogue_file(name)))
    assert text.startswith(f"# Started from {name}, of the catalogue")
    changed = set(source.splitlines()) - set(text.splitlines())
    assert changed == {
        line for line in source.splitlines() if line.startswith(("name = ", "radiation = "))
    } - {line for line in source.splitlines() if line.startswith("name = ") and line in text.splitlines()}


def test_tables_that_a_vehicle_names_go_along(tmp_path: Path) -> None:
    file, table = export_vehicle("supply_vessel", tmp_path / "ship.toml")
    assert table.name == "ship_radiation.csv"
    assert 'radiation = "ship_radiation.csv"' in file.read_text(encoding="utf-8")
    assert (
        table.read_bytes()
        == (catalogue_file("supply_vessel").with_name("supply_vessel_radiation.csv")).read_bytes()
    )
    frequencies = [load_vehicle(one).radiation.frequencies for one in (file, "supply_vessel")]  # type: ignore[union-attr]
    np.testing.assert_array_equal(*frequencies)


@pytest.mark.parametrize("there", ["ship.toml", "ship_radiation.csv"])
def test_files_that_are_there_are_replaced_only_when_asked(there: str, tmp_path: Path) -> None:
    (tmp_path / there).write_text("mine", encoding="utf-8")
    with pytest.raises(
        InvalidInputError, match=rf"{there} exists; choose another name, or replace it with --force"
    ):
        export_vehicle("supply_vessel", tmp_path / "ship.toml")
    assert [path.read_text(encoding="utf-8") for path in tmp_path.iterdir()] == ["mine"]
    assert len(export_vehicle("supply_vessel", tmp_path / "ship.toml", force=True)) == 2
    load_vehicle(tmp_path / "ship.toml")


@pytest.mark.parametrize(
    ("name", "file", "message"),
    [
        ("titanic", "ship.toml", "no vehicle 'titanic' in the catalogue; it holds .*rexrov"),
        ("rexrov", "ship.txt", r"ship\.txt has the ending '\.txt'; give a file that ends in \.toml"),
        ("rexrov", "folder.toml", r"folder\.toml is a folder"),
        ("rexrov", "no/ship.toml", r"ship\.toml cannot be written"),
    ],
)
def test_mistakes_are_told(name: str, file: str, message: str, tmp_path: Path) -> None:
    (tmp_path / "folder.toml").mkdir()
    with pytest.raises(InvalidInputError, match=message):
        export_vehicle(name, tmp_path / file, force=True)
    assert [path.name for path in tmp_path.iterdir()] == ["folder.toml"]
