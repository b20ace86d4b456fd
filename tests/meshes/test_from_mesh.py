"""Vehicles from meshes: complete files that load again; nothing physical depends on the mesh's frame; bad input."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.bodies import PlainBody
from support.solids import box, ellipsoid, write_ascii_stl, write_stl
from typer.testing import CliRunner

from dq_marine import Scene
from dq_marine.cli.main import app
from dq_marine.errors import InvalidInputError, MissingDependencyError
from dq_marine.meshes import Choices, vehicle_from_mesh
from dq_marine.meshes import potential_flow as solver
from dq_marine.physics.radiation.build import radiation_model
from dq_marine.vehicles import Vehicle, load_vehicle
from dq_marine.viewer.models.own_mesh import own_mesh

WITHOUT_SOLVER = "needs the extra `bem`"


def made(mesh: Path, choices: Choices) -> Vehicle:
    """The vehicle as its file has it."""
    file = mesh.with_suffix(".toml")
    built, _ = vehicle_from_mesh(mesh, file, choices)
    assert load_vehicle(file) == built.vehicle
    file.unlink()
    return built.vehicle


def test_an_ellipsoid_makes_a_complete_vehicle(tmp_path: Path) -> None:
    pytest.importorskip("capytaine", reason=WITHOUT_SOLVER)
    mesh = write_stl(tmp_path / "hull.stl", 1000.0 * ellipsoid(0.8, 0.1, 0.12))
    vehicle = made(mesh, Choices(mass=38.0, unit="mm", panels=100))
    assert vehicle.rigid_body.mass == 38.0
    assert vehicle.buoyancy.center == (0.0, 0.0, 0.0)
    assert vehicle.rigid_body.center_of_mass == pytest.approx((0.0, 0.0, 0.05 * 0.24), rel=1e-6)
    assert (vehicle.dimensions.length, vehicle.dimensions.shape) == (pytest.approx(1.6), "torpedo")
    added = vehicle.added_mass_matrix
    np.testing.assert_array_equal(added, np.diag(added.diagonal()))
    assert (vehicle.linear_damping.diagonal() > 0.0).all()
    assert (vehicle.wrench_limits > 0.0).all()
    assert vehicle.validity is not None
    assert vehicle.validity.speed == 1.5
    assert vehicle.validity.wave_height is None


def test_a_barge_floats_as_the_textbook_says(tmp_path: Path) -> None:
    pytest.importorskip("capytaine", reason=WITHOUT_SOLVER)
    length, width, draft, density, gravity = 10.0, 4.0, 1.0, 1025.0, 9.81
    vehicle = made(
        write_stl(tmp_path / "barge.stl", box(length, width, 2.0)), Choices(draft=draft, panels=100)
    )
    mass = density * length * width * draft
    assert vehicle.rigid_body.mass == pytest.approx(mass, rel=1e-6)
    above = 0.5 * draft  # of the centre of mass, in the middle of the hull, over that of buoyancy
    heights = width**2 / (12 * draft) - above, length**2 / (12 * draft) - above
    expected = np.diag([density * gravity * length * width, *(mass * gravity * one for one in heights)])
    np.testing.assert_allclose(vehicle.waterplane_stiffness, expected, rtol=1e-6, atol=1e-3)
    assert vehicle.hydrostatics is not None
    assert vehicle.hydrostatics.equilibrium_depth == 0.0
    assert vehicle.validity is not None
    crest_over_height = 0.5 * np.sqrt(0.5 * np.log(1000.0))  # of the largest of a thousand waves
    assert vehicle.validity.wave_height == pytest.approx(draft / crest_over_height, rel=1e-3)


def test_the_frame_of_the_mesh_changes_nothing_physical(tmp_path: Path) -> None:
    """Other axes, unit, place and kind of file: the same vehicle, but for the digits that an STL file has."""
    pytest.importorskip("capytaine", reason=WITHOUT_SOLVER)
    corners = box(2.0, 1.0, 0.5) @ np.array([[1.0, 0.1, 0.05], [0.0, 1.0, 0.0], [0.1, 0.0, 1.0]])
    choices = Choices(draft=0.25, panels=100, water_density=1000.0, origin="center")
    plain = made(write_ascii_stl(tmp_path / "hull.stl", corners), choices)
    moved = (corners + np.array([3.0, -2.0, 7.0])) @ np.diag([1.0, -1.0, -1.0]) / 0.0254
    other = made(write_ascii_stl(tmp_path / "hull.stl", moved), replace(choices, axes="fsd", unit="in"))
    by_mass = replace(choices, draft=None, mass=plain.rigid_body.mass, afloat=True)
    for vehicle in (other, made(write_ascii_stl(tmp_path / "hull.stl", corners), by_mass)):
        for attribute in ("added_mass_matrix", "rigid_body_matrix", "waterplane_stiffness", "linear_damping"):
            one, two = (np.asarray(getattr(which, attribute)) for which in (plain, vehicle))
            np.testing.assert_allclose(two, one, rtol=1e-5, atol=1e-6 * np.abs(one).max(), err_msg=attribute)


def test_the_origin_of_the_mesh_may_be_the_body_origin(tmp_path: Path) -> None:
    """Energy does not depend on the reference point: M is the same matrix, moved."""
    pytest.importorskip("capytaine", reason=WITHOUT_SOLVER)
    mesh = write_stl(tmp_path / "hull.stl", box(2.0, 1.0, 0.5) + np.array([0.25, 0.0, -0.125]))
    choices = Choices(draft=0.25, panels=100)
    center, own = made(mesh, choices), made(mesh, replace(choices, origin="mesh"))
    # The waterline is 0.125 m over the mesh's origin, its middle 0.25 m ahead of it.
    x, z = 0.25, -0.125
    lever = np.array([[0.0, -z, 0.0], [z, 0.0, -x], [0.0, x, 0.0]])
    change = np.block([[np.eye(3), -lever], [np.zeros((3, 3)), np.eye(3)]])
    expected = change.T @ center.mass_matrix @ change
    np.testing.assert_allclose(own.mass_matrix, expected, rtol=1e-3, atol=1e-3 * expected.max())
    assert own.equilibrium_depth == pytest.approx(0.125, abs=1e-6)


@pytest.mark.parametrize("origin", ["center", "mesh"])
def test_the_mesh_is_drawn_where_the_hull_is(tmp_path: Path, origin: str) -> None:
    pytest.importorskip("capytaine", reason=WITHOUT_SOLVER)
    pytest.importorskip("trimesh", reason="needs the extra `models`")
    (tmp_path / "meshes").mkdir()
    corners = (box(2.0, 1.0, 0.5) + np.array([0.25, 0.1, -0.125])) / 0.0254
    mesh, file = write_stl(tmp_path / "meshes" / "hull.stl", corners), tmp_path / "mine.toml"
    built, _ = vehicle_from_mesh(mesh, file, Choices(draft=0.25, panels=100, unit="in", origin=origin))
    assert 'file = "meshes/hull.stl"' in file.read_text(encoding="utf-8")
    appearance = load_vehicle(file).appearance
    assert appearance is not None
    drawn = own_mesh(appearance)
    assert drawn is not None
    for pick in (np.min, np.max):
        expected = pick(built.hull.surface.vertices, axis=0)
        np.testing.assert_allclose(pick(drawn.mesh.vertices, axis=0), expected, atol=1e-6)


@pytest.mark.slow
def test_radiation_goes_beside_the_file(tmp_path: Path) -> None:
    pytest.importorskip("capytaine", reason=WITHOUT_SOLVER)
    mesh, file = write_stl(tmp_path / "barge.stl", box(10.0, 4.0, 2.0)), tmp_path / "barge.toml"
    choices = Choices(draft=1.0, panels=150, frequencies=3)
    _, files = vehicle_from_mesh(mesh, file, choices)
    assert [one.name for one in files] == ["barge.toml", "barge_radiation.csv"]
    loaded = load_vehicle(file).radiation
    assert loaded is not None
    added, damping = np.array(loaded.added_mass), np.array(loaded.damping)
    assert added.shape == damping.shape == (3, 6, 6)
    for matrices in (added, damping):
        np.testing.assert_array_equal(matrices, matrices.transpose(0, 2, 1))
        assert (np.linalg.eigvalsh(matrices) > -0.02 * np.trace(matrices, axis1=1, axis2=2)[:, None]).all()
    with pytest.raises(InvalidInputError, match="exists; choose another name, or replace it with --force"):
        vehicle_from_mesh(mesh, file, choices)


@pytest.mark.slow
@pytest.mark.sweep
def test_a_barge_from_a_mesh_remembers_its_waves(tmp_path: Path) -> None:
    """Its file says what of its damping the memory replaces, and the model reproduces the panels' table."""
    pytest.importorskip("capytaine", reason=WITHOUT_SOLVER)
    mesh, file = write_stl(tmp_path / "barge.stl", box(10.0, 4.0, 2.0)), tmp_path / "barge.toml"
    vehicle_from_mesh(mesh, file, Choices(draft=1.0, panels=800, frequencies=10))
    vehicle = load_vehicle(file)
    assert vehicle.damping.wave_share is not None
    assert (np.array(vehicle.damping.wave_share)[2:5] > 0.0).all()
    for quality in radiation_model(vehicle).quality.values():
        assert quality.damping < 0.15
        assert quality.added_mass < 0.03
    scene = Scene(vehicle, step=0.05, radiation="memory")
    body = PlainBody(scene.composition, scene.parameters_at, scene.step)
    body.reset(velocity_body=[0.0, 0.0, 0.05, 0.02, 0.02, 0.0])
    before = np.abs(body.velocity_body[2:5])
    body.step(steps=300)
    assert (np.abs(body.velocity_body[2:5]) < 0.2 * before).all()
    assert np.abs(body.fluid_memory).max() > 0.0


CUBE = box(1.0, 1.0, 1.0)
HULL = box(10.0, 4.0, 2.0)


@pytest.mark.parametrize(
    ("corners", "options", "message"),
    [
        (CUBE[1:], {}, "is not closed"),
        (1000.0 * CUBE, {}, "is 1000 m long, read in m.*--unit mm"),
        (0.001 * CUBE, {}, "is 0.001 m long"),
        (100.0 * CUBE, {"mass": 30.0}, "times as dense as water.*--unit mm"),
        (HULL, {"mass": 1e6, "afloat": True}, "cannot float: it encloses 80 m"),
        (HULL, {"draft": 2.5}, "draft = 2.5 m, but the hull is 2 m high"),
        (
            HULL,
            {"draft": 1.0, "center_of_mass": (0.0, 0.0, -9.0)},
            "capsizes with its centre of mass at z = -9",
        ),
        (HULL, {"draft": 1.0, "center_of_mass": (1.0, 0.0, 0.0)}, "trims by -7.31 degrees"),
    ],
)
def test_bad_meshes_are_refused_and_nothing_is_written(
    corners: np.ndarray, options: dict[str, Any], message: str, tmp_path: Path
) -> None:
    mesh = write_stl(tmp_path / "hull.stl", corners)
    with pytest.raises(InvalidInputError, match=message):
        vehicle_from_mesh(mesh, tmp_path / "hull.toml", Choices(**options))
    assert list(tmp_path.iterdir()) == [mesh]


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"mass": -1.0}, "mass = -1 is not finite and above 0"),
        ({"mass": float("nan")}, "mass = nan"),
        ({"unit": "km"}, "unit = 'km' is unknown"),
        ({"axes": "xyz"}, "axes = 'xyz' is unknown"),
        ({"shape": "duck"}, "shape = 'duck' is unknown"),
        ({"draft": 1.0, "mass": 3.0}, "says the mass, too"),
        ({"afloat": True}, "needs its mass or its draft"),
        ({"frequencies": 4}, "radiation is of a hull afloat"),
        ({"panels": 50}, "panels = 50 is below 100"),
        ({"limits": (1.0, 0.0, 0.0, 0.0, 0.0, -1.0)}, "has a number below 0"),
        ({"center_of_mass": (1.0, 0.0)}, "center_of_mass has shape"),
        ({"gravity": "9.81"}, "gravity = '9.81' is not numeric"),
        ({"gravity": 900.0}, "gravity = 900"),
        ({"afloat": [1, 2]}, r"afloat = \[1, 2\]; give True or False"),
        ({"name": 3}, "name = 3; give a text"),
    ],
)
def test_choices_that_cannot_be_are_refused(options: dict[str, Any], message: str) -> None:
    with pytest.raises(InvalidInputError, match=message):
        Choices(**options)


def test_without_capytaine_the_extra_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "capytaine", None)
    mesh = write_stl(tmp_path / "hull.stl", CUBE)
    with pytest.raises(MissingDependencyError, match=r'pip install "dq-marine\[bem\]"'):
        vehicle_from_mesh(mesh, tmp_path / "hull.toml", Choices())
    assert list(tmp_path.iterdir()) == [mesh]


def test_an_added_mass_that_no_body_has_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    mesh = write_stl(tmp_path / "hull.stl", CUBE)
    for diagonal in ([-1.0, 1.0, 1.0, 1.0, 1.0, 1.0], [np.nan] * 6):
        found = np.diag(diagonal)[None]
        monkeypatch.setattr(solver.PotentialFlow, "_solved", lambda *_, found=found, **__: (found, found))
        with pytest.raises(InvalidInputError, match="gives an added mass that is not positive"):
            vehicle_from_mesh(mesh, tmp_path / "hull.toml", Choices())
    assert list(tmp_path.iterdir()) == [mesh]


def test_the_help_shows_units_and_examples() -> None:
    """Brackets would be taken for markup, and left out."""
    text = " ".join(
        CliRunner().invoke(app, ["vehicles", "from-mesh", "--help"], env={"COLUMNS": "200"}).stdout.split()
    )
    for words in (
        "so many metres deep",
        "in kg m^2",
        "the extra bem",
        "from-mesh barge.stl --draft 0.4 --radiation",
    ):
        assert words in text


def test_the_command_writes_a_file_that_checks(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("capytaine", reason=WITHOUT_SOLVER)
    monkeypatch.chdir(tmp_path)
    write_stl(Path("rov.stl"), box(0.457, 0.338, 0.254))
    arguments = ["vehicles", "from-mesh", "rov.stl", "--panels", "100", "--center-of-mass", "0,0,0.02"]
    result = CliRunner().invoke(app, arguments)
    assert result.exit_code == 0, result.stderr
    assert "Hull of 0.457 x 0.338 x 0.254 m" in result.stdout
    assert "Wrote my_rov.toml" in result.stdout
    text = Path("my_rov.toml").read_text(encoding="utf-8")
    for words in (
        "Capytaine, direct method",
        "C_D = 1.05 of a cube",
        "as an estimate",
        "centre of mass: given",
    ):
        assert words in text
    assert CliRunner().invoke(app, ["vehicles", "check", "my_rov.toml"]).exit_code == 0
    again = CliRunner().invoke(app, arguments)
    assert (again.exit_code, "exists; choose another name" in again.stderr) == (1, True)
    assert CliRunner().invoke(app, [*arguments, "--force"]).exit_code == 0
    wrong = CliRunner().invoke(app, ["vehicles", "from-mesh", "rov.stl", "x.toml", "--inertia", "1,b"])
    assert (wrong.exit_code, "--inertia: the value is neither TOML nor JSON" in wrong.stderr) == (1, True)
