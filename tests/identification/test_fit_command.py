"""The command `dq-marine vehicles fit`: what it prints and writes, and that a mistake writes nothing."""

from __future__ import annotations

import json
import tomllib

import pytest
from identification.logs import COLUMNS, GROUPS, STEP, rov_log, written
from support.command_line import assert_refused, run

from dq_marine import load_vehicle

FIT = ",".join(GROUPS)
COMMON = ("--fit", FIT, "--step", STEP)


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def fit(*options):
    return run("vehicles", "fit", "bluerov2_heavy", "--log", "run.csv", *COMMON, *options)


@pytest.mark.sweep
def test_a_fitted_vehicle_is_a_file_with_its_provenance(folder):
    written(folder / "run.csv", rov_log(5, 120.0, (2,)))
    result = fit("--out", "fitted.toml", "--json")
    assert result.exit_code == 0, result.stderr
    content = json.loads(result.stdout)
    assert content["vehicle"] == "BlueROV2 Heavy"
    assert [one["label"] for one in content["estimates"]][-1] == "quadratic damping, heave"
    assert "added mass, sway" in {one["label"] for one in content["held"]}
    assert "Wrote fitted.toml" in result.stderr

    vehicle, nominal = load_vehicle("fitted.toml"), load_vehicle("bluerov2_heavy")
    found = {one["label"]: one["found"] for one in content["estimates"]}
    assert vehicle.name == "BlueROV2 Heavy (fitted)"
    assert vehicle.quadratic_damping[2] == found["quadratic damping, heave"]
    assert vehicle.added_mass_matrix[2, 2] == found["added mass, heave"]
    assert vehicle.quadratic_damping[1] == nominal.quadratic_damping[1]
    assert vehicle.thrusters == nominal.thrusters
    assert "run.csv" in vehicle.sources[0]
    assert vehicle.sources[1:] == nominal.sources

    text = (folder / "fitted.toml").read_text()
    assert "# BlueROV2 Heavy, its numbers identified from run.csv: 120 s of motion" in text
    assert "+-" in text
    assert "not told by the log" in text
    assert (folder / "fitted.png").read_bytes().startswith(b"\x89PNG")
    assert len(tomllib.loads(text)["added_mass"]) == 6

    assert_refused(fit("--out", "fitted.toml"), r"fitted\.toml exists; .*--force")


def test_a_table_for_people(folder):
    written(folder / "run.csv", rov_log(5, 120.0, (2,)))
    result = fit("--no-plot")
    assert result.exit_code == 0, result.stderr
    assert "quadratic damping, heave" in result.stdout
    assert "Note: The log does not tell" in result.stdout
    assert sorted(path.name for path in folder.iterdir()) == ["bluerov2_heavy_fitted.toml", "run.csv"]


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--fit", "mass"), r"fit = 'mass' is unknown"),
        (("--fit", "gains"), r"which gains play no part in"),
        (("--fit", "cross_flow"), r"nothing of cross_flow to fit"),
        (("--bound", "0"), r"bound = 0 is not finite and above 0"),
        (("--segment", "0.1"), r"segment = 0\.1; give at least 1"),
        (("--segment", "1e9"), r"segment = 1e\+09; give at most"),
        (("--step", "nan"), r"step = nan is not finite"),
        (("--step", "1e-308"), r"step = 1e-308; give at least 0\.0001"),
        (("--current", "1,2"), r"current has shape \(2,\); give shape \(3,\)"),
        (("--out", "fitted.json"), r"ending '\.json'; give a file that ends in \.toml"),
        (("--out", "nowhere/fitted.toml"), r"the folder nowhere does not exist"),
        (("--plot", "residuals.txt"), r"residuals\.txt has no ending that pictures have"),
        (("--log", "nowhere.csv"), r"there is no file 'nowhere\.csv'"),
    ],
)
def test_mistakes_are_answered_and_nothing_is_written(folder, options, message):
    rows = [[0.1 * i, *[0.0] * (len(COLUMNS) - 1)] for i in range(200)]
    written(folder / "run.csv", rows)
    assert_refused(fit(*options), message)
    assert [path.name for path in folder.iterdir()] == ["run.csv"]


def test_a_bad_log_writes_nothing(folder):
    rows = [[0.1 * i, *[0.0] * (len(COLUMNS) - 1)] for i in range(200)]
    rows[100][5] = "nan"
    written(folder / "run.csv", rows)
    assert_refused(fit(), r"line 102: u_m_s = 'nan' is no finite number")
    assert [path.name for path in folder.iterdir()] == ["run.csv"]


@pytest.mark.parametrize("place", [".", "/", "..", ""])
def test_a_folder_is_no_file_for_a_vehicle(folder, place):
    """The campaign of hostile cases found this: case 11,037,024."""
    assert_refused(fit("--out", place), r"has the ending ''; give a file that ends in \.toml")


def test_help_teaches_the_log():
    text = run("vehicles", "fit", "--help").output
    for word in ("time_s", "u_m_s", "added_mass_full", "--log", "fly --trajectory"):
        assert word in text
