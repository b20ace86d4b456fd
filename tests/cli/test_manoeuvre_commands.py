"""The commands `dq-marine manoeuvre`: figures, files, and what they say of mistakes."""

from __future__ import annotations

import csv
import json
import re

import pytest
from support.sweeps import sweep
from typer.testing import CliRunner

from dq_marine.cli.main import app
from dq_marine.manoeuvres.views import VIEWS

NAMES = ["turning-circle", "zig-zag", "spiral", "acceleration", "stopping", "decay"]
VEHICLE = "bluerov2_heavy"


@pytest.fixture
def run(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return lambda *arguments: CliRunner().invoke(app, ["manoeuvre", *map(str, arguments)])


def test_every_manoeuvre_has_a_picture_and_a_command():
    assert sorted(VIEWS) == sorted(NAMES)


@pytest.mark.parametrize("name", NAMES)
def test_figures_as_json_and_a_picture(run, tmp_path, name):
    result = run(VEHICLE, name, "--json")
    assert result.exit_code == 0, result.stderr
    content = json.loads(result.stdout)
    assert (content["manoeuvre"], content["vehicle"]) == (name, "BlueROV2 Heavy")
    assert content["settings"]["step_s"] > 0.0
    assert None not in content["quantities"].values()
    picture = tmp_path / f"{VEHICLE}-{name}.png"
    assert picture.read_bytes().startswith(b"\x89PNG")
    assert f"Wrote {picture.name}" in result.stderr


def test_a_table_for_people_and_the_series_as_csv(run, tmp_path):
    result = run(VEHICLE, "zig-zag", "--no-plot", "--csv", "series.csv", "--angle", 20)
    assert result.exit_code == 0, result.stderr
    assert re.search(r"overshoot 1, to starboard\s+│\s+[\d.]+ │ deg", result.stdout)
    assert "its numbers hold up to 0.7 m/s" in " ".join(result.stdout.split())
    with (tmp_path / "series.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert float(rows[0]["time_s"]) < 0.0 < float(rows[-1]["time_s"])
    assert {float(row["helm"]) for row in rows} >= {20.0 / 35.0, -20.0 / 35.0}
    assert list(tmp_path.iterdir()) == [tmp_path / "series.csv"]


@pytest.mark.parametrize("ending", sweep(["svg", "pdf"], plain=["svg"]))
def test_pictures_are_the_same_each_time(run, tmp_path, ending):
    contents = []
    for _ in range(2):
        assert run(VEHICLE, "turning-circle", "--plot", f"circle.{ending}").exit_code == 0
        contents.append((tmp_path / f"circle.{ending}").read_bytes())
    assert contents[0] == contents[1]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("no_such_vehicle", "spiral"), "no vehicle 'no_such_vehicle'.*the catalogue holds"),
        ((VEHICLE, "turning-circle", "--helm", "1.5"), "helm = 1.5 is above 1"),
        ((VEHICLE, "acceleration", "--throttle", "0"), "throttle = 0 is not finite and above 0"),
        ((VEHICLE, "zig-zag", "--angle", "120"), "not below pi/2"),
        ((VEHICLE, "decay", "--motion", "heave"), "only vessels that float"),
        ((VEHICLE, "stopping", "--plot", "stop.bmp"), r"end it with one of \.png, \.svg, \.pdf"),
        (
            (VEHICLE, "decay", "--radiation", "memory"),
            'no added mass and damping by frequency.*radiation="con',
        ),
        (
            (VEHICLE, "spiral", "--radiation", "memory"),
            'no added mass and damping by frequency.*radiation="con',
        ),
        ((VEHICLE, "stopping", "--step", "-1"), "step = -1; give at least 1e-05"),
        ((VEHICLE, "zig-zag", "--step", "1e-308"), "step = 1e-308; give at least 1e-05"),
    ],
)
def test_mistakes_are_named_with_their_remedy(run, tmp_path, arguments, message):
    result = run(*arguments)
    assert result.exit_code == 1
    assert result.stdout == ""
    assert re.search(message, result.stderr, re.DOTALL), result.stderr
    assert "Traceback" not in result.stderr
    assert not list(tmp_path.iterdir())


def test_an_unknown_manoeuvre_is_refused(run):
    result = run(VEHICLE, "pirouette")
    assert result.exit_code == 2
    assert "No such command 'pirouette'" in result.stderr
