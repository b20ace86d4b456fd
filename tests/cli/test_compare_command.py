"""The command `compare`: agents or settings from one start, in one page; and the integrator beside RK4."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from support.command_line import assert_refused, run
from viewer.commands import commands_in, constant_in, track_in

from dq_marine.cli.variants import read_variants
from dq_marine.errors import InvalidInputError


def test_agents_from_one_start(tmp_path: Path) -> None:
    page = tmp_path / "agents.html"
    result = run("compare", "--seconds", "2", "--seed", "3", "--current", "0.2,0,0", "--html", page)
    assert result.exit_code == 0, result.output
    assert re.search(r"controller\s+┃\s+zero", result.output)
    start = re.search(r"position error, start\s+│\s+(\S+) m\s+│\s+(\S+) m", result.output)
    assert start is not None
    assert start[1] == start[2]
    assert f"Wrote {page}" in result.output.replace("\n", "")
    commands = commands_in(page)
    tracks = [track_in(commands, path, "position") for path in ("/world/vehicle", "/world/flights/1/vehicle")]
    for times, positions in tracks:
        assert_allclose(times, np.arange(21) / 10.0, atol=1e-6)
        assert_allclose(positions[0], tracks[0][1][0])
    assert np.abs(tracks[0][1][-1] - tracks[1][1][-1]).max() > 0.05
    told = constant_in(page, "overlay")
    assert [chart["label"] for chart in told["charts"]] == ["position error [m]", "attitude error [deg]"]
    assert told["flights"][0]["plots"]["position error [m]"][0] == pytest.approx(float(start[1]), abs=5e-4)


def test_settings_from_one_start_though_each_would_draw_another(tmp_path: Path) -> None:
    page = tmp_path / "settings.html"
    near, far = "near: start_radius=0.5", "far, and slow: start_radius=1.5, control_period=0.15"
    result = run("compare", "--seconds", "0.9", "--with", near, "--with", far, "--html", page)
    assert result.exit_code == 0, result.output
    assert [one["name"] for one in constant_in(page, "overlay")["flights"]] == ["near", "far, and slow"]
    commands = commands_in(page)
    (times, one), (later, other) = (
        track_in(commands, path, "position") for path in ("/world/vehicle", "/world/flights/1/vehicle")
    )
    assert_allclose(one[0], other[0], atol=1e-6)
    assert (len(times), len(later)) == (10, 7)


def test_side_by_side(tmp_path: Path) -> None:
    page = tmp_path / "beside.html"
    result = run("compare", "--seconds", "0.5", "--current", "0.2,0,0", "--side-by-side", "--html", page)
    assert result.exit_code == 0, result.output
    assert re.findall("<h2>(.*)</h2>", page.read_text(encoding="utf-8")) == ["controller", "zero"]


@pytest.mark.parametrize(
    ("arguments", "pattern"),
    [
        (("--with", "a: order=2", "--with", "a: order=4"), "two settings called 'a'"),
        (("--with", "a: ordre=2"), "ordre"),
        (("--with", "a:"), "changes nothing; give KEY=VALUE"),
        (("--with", "a: order"), "--with order does not name a keyword"),
        (("--with", "a: vehicle='otter"), "neither TOML nor JSON"),
        (("--agent", "zero", "--agent", "zero"), "two flights called 'zero'"),
        (("--agent", "zero", *(f"--with=current={n}" for n in range(7))), "7 flights.*colours for 6"),
        (("--html", "/nowhere/at/all.html", "--agent", "zero"), "/nowhere/at"),
        (("--step", "0.1"), "--step 0.1 goes with --integrators"),
        (("--integrators", "--agent", "zero"), "--agent does not go with --integrators"),
        (("--integrators", "--step", "0"), "step = 0 s"),
    ],
)
def test_what_cannot_be_compared_is_refused(arguments: tuple[str, ...], pattern: str) -> None:
    assert_refused(run("compare", *arguments), pattern)


def test_variants_are_read() -> None:
    texts = ["order 8: scheme=galerkin, order=8", "stream: current=0.2,0,0 level=easy", "control_period=0.2"]
    assert read_variants(texts) == {
        "order 8": {"scheme": "galerkin", "order": 8},
        "stream": {"current": [0.2, 0, 0], "level": "easy"},
        "control_period=0.2": {"control_period": 0.2},
    }
    weather = 'windy: weather=[{"kind": "wind", "speed": 8}], order=2'
    assert read_variants([weather])["windy"] == {"weather": [{"kind": "wind", "speed": 8}], "order": 2}
    with pytest.raises(InvalidInputError, match="changes nothing"):
        read_variants(["a: "])


@pytest.mark.sweep
def test_rk4_blows_up_in_the_page_and_the_integrator_does_not(tmp_path: Path) -> None:
    page = tmp_path / "integrators.html"
    result = run("compare", "--integrators", "--html", page)
    assert result.exit_code == 0, result.output
    own, rk4, exact = constant_in(page, "overlay")["flights"]
    failed = re.search(r"runs away at step (\d+) of 40, (\S+) s", rk4["caption"])
    assert failed is not None
    assert rk4["times"][-1] == pytest.approx(0.5 * int(failed[1])) == float(failed[2])
    assert own["times"][-1] == pytest.approx(20.0)
    assert exact["times"][-1] == pytest.approx(20.0)
    commands = commands_in(page)
    for path in ("/world/vehicle", "/world/flights/1/vehicle", "/world/flights/2/vehicle"):
        assert np.isfinite(track_in(commands, path, "position")[1]).all()
        assert np.isfinite(track_in(commands, path, "quaternion")[1]).all()
