"""The command `dq-marine sea`."""

import json

import pytest
from typer.testing import CliRunner

from dq_marine.cli.main import app
from dq_marine.physics.weather import Jonswap, ModifiedPiersonMoskowitz


def run(*arguments):
    return CliRunner().invoke(app, ["sea", *map(str, arguments)])


def test_it_tells_the_seas_numbers():
    result = run("--hs", 2, "--tp", 8, "--seconds", 10_000, "--json")
    numbers = json.loads(result.output)
    assert numbers["significant height [m]"] == 2.0
    assert numbers["wave length at peak [m]"] == pytest.approx(9.81 * 64.0 / 6.283185307, rel=1e-6)
    assert numbers["record: 4 std [m]"] == pytest.approx(2.0, rel=0.03)
    assert numbers["mean period T1 [s]"] == pytest.approx(0.834 * 8.0, rel=0.01)  # of Jonswap, gamma 3.3
    table = run("--hs", 2, "--tp", 8).output
    assert "peak period [s]" in table


def test_a_sea_by_wind_or_by_its_mean_period():
    by_wind = json.loads(run("--spectrum", "pierson-moskowitz", "--wind-speed", 15, "--json").output)
    assert by_wind["significant height [m]"] == pytest.approx(0.0246 * 15.0**2 * 0.867, rel=0.01)
    by_period = json.loads(
        run("--spectrum", "ittc", "--hs", 3, "--t1", 7, "--water-depth", 20, "--json").output
    )
    assert by_period["mean period T1 [s]"] == pytest.approx(7.0, rel=2e-3)
    assert ModifiedPiersonMoskowitz(3.0, 7.0).zero_crossing_period == pytest.approx(0.92 * 7.0, rel=0.01)
    assert Jonswap(3.0, 9.0, gamma=1.0).mean_of_periods == pytest.approx(0.772 * 9.0, rel=2e-3)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((), "--hs, --tp is missing"),
        (("--hs", 2), "--tp is missing"),
        (("--hs", 2, "--tp", 8, "--wind-speed", 3), "--wind-speed is not asked"),
        (("--hs", 9, "--tp", 5), "waves break"),
        (("--hs", 2, "--tp", 8, "--plot", "sea.xyz"), "ending"),
        (("--hs", 2, "--tp", 8, "--seconds", 0), "seconds"),
    ],
)
def test_what_is_wrong_is_said(arguments, message):
    result = run(*arguments)
    assert result.exit_code == 1
    assert message in " ".join(result.stderr.split())


def test_it_draws_a_picture(tmp_path):
    picture = tmp_path / "sea.png"
    assert run("--hs", 2, "--tp", 8, "--plot", picture).exit_code == 0
    assert picture.read_bytes().startswith(b"\x89PNG")
