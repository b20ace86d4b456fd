"""A vehicle's own mesh: where it is in body axes, its edges and colours, and files that are none."""

from __future__ import annotations

from dataclasses import replace
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pydantic import ValidationError
from support.solids import box, ellipsoid, write_stl
from viewer.samples import ROV, snapshot

from dq_marine.errors import InvalidInputError, VehicleFileError
from dq_marine.vehicles import load_vehicle
from dq_marine.vehicles.appearance import DIRECTIONS, Appearance
from dq_marine.vehicles.loading import catalogue_file
from dq_marine.viewer import OffscreenViewer
from dq_marine.viewer.models import own_mesh as module
from dq_marine.viewer.models.own_mesh import own_mesh
from dq_marine.viewer.models.vehicle_model import draw_goal, draw_vehicle

trimesh = pytest.importorskip("trimesh", reason="needs the extra `models`")
pytest.importorskip("scipy", reason="needs the extra `models`")

RED, BLUE = (255, 0, 0, 255), (0, 0, 255, 255)


def mesh_of(file: Path, **fields: Any) -> module.OwnMesh:
    read = own_mesh(Appearance(file=str(file), **fields))
    assert read is not None
    return read


def glb(path: Path) -> Path:
    """A red box of 2 x 1 x 1 five to the left of a blue ball, as glTF has its axes: x left, y up, z forward."""
    block = trimesh.creation.box((1.0, 1.0, 2.0))
    block.visual.vertex_colors = RED
    ball = trimesh.creation.icosphere(subdivisions=2, radius=0.5)
    ball.visual = trimesh.visual.TextureVisuals(
        material=trimesh.visual.material.PBRMaterial(baseColorFactor=BLUE)
    )
    scene = trimesh.Scene()
    scene.add_geometry(block, transform=trimesh.transformations.translation_matrix([5.0, 0.0, 0.0]))
    scene.add_geometry(ball)
    scene.export(str(path))
    return path


def test_axes_are_right_handed_triples(tmp_path: Path) -> None:
    taken = []
    for letters in product(DIRECTIONS, repeat=3):
        axes = "".join(letters)
        try:
            rotation = Appearance(file="hull.stl", axes=axes).rotation
        except ValidationError as error:
            assert "right-handed" in str(error)
        else:
            taken.append(axes)
            np.testing.assert_array_equal(rotation @ rotation.T, np.eye(3))
            for axis, letter in enumerate(letters):
                np.testing.assert_array_equal(rotation[:, axis], DIRECTIONS[letter])
    assert len(taken) == 24
    assert {"flu", "fsd", "luf", "fus"} <= set(taken)


def test_an_stl_is_turned_scaled_and_shifted(tmp_path: Path) -> None:
    corners = box(2.0, 1.0, 0.5) + np.array([0.3, 0.2, 0.1])  # forward, to port, up
    file = write_stl(tmp_path / "hull.stl", 1000.0 * corners)
    vertices = mesh_of(file, unit="mm", origin=(0.0, 0.0, 0.25)).mesh.vertices
    np.testing.assert_allclose(vertices.min(axis=0), [-0.7, -0.7, -0.35], atol=1e-6)
    np.testing.assert_allclose(vertices.max(axis=0), [1.3, 0.3, 0.15], atol=1e-6)


def test_edges_are_sharp_and_curves_smooth(tmp_path: Path) -> None:
    block = mesh_of(write_stl(tmp_path / "box.stl", box(2.0, 1.0, 0.5))).mesh
    assert len(block.vertices) == 24
    np.testing.assert_allclose(np.sort(np.abs(block.normals), axis=1), [[0.0, 0.0, 1.0]] * 24, atol=1e-9)
    round_one = mesh_of(write_stl(tmp_path / "ball.stl", ellipsoid(1.0, 1.0, 1.0, splits=3))).mesh
    assert len(round_one.vertices) == 258
    np.testing.assert_allclose(round_one.normals, round_one.vertices, atol=0.05)


def test_normals_point_outwards_in_all_axes(tmp_path: Path) -> None:
    file = write_stl(tmp_path / "ball.stl", ellipsoid(3.0, 2.0, 1.0))
    for axes in ("flu", "fsd", "luf"):
        mesh = mesh_of(file, axes=axes).mesh
        assert (np.einsum("ij,ij->i", mesh.vertices, mesh.normals) > 0.0).all()
        corners = mesh.vertices[mesh.triangles]
        faces = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        assert (np.einsum("ij,ij->i", faces, corners.mean(axis=1)) > 0.0).all()


def test_a_glb_has_its_places_and_colours(tmp_path: Path) -> None:
    read = mesh_of(glb(tmp_path / "rov.glb"))
    red = read.colors[:, 0] > 0.5
    np.testing.assert_array_equal(read.colors[red], [[1.0, 0.0, 0.0]] * int(red.sum()))
    np.testing.assert_array_equal(read.colors[~red], [[0.0, 0.0, 1.0]] * int((~red).sum()))
    block, ball = read.mesh.vertices[red], read.mesh.vertices[~red]
    np.testing.assert_allclose(block.min(axis=0), [-1.0, -5.5, -0.5], atol=1e-6)
    np.testing.assert_allclose(block.max(axis=0), [1.0, -4.5, 0.5], atol=1e-6)
    np.testing.assert_allclose(np.linalg.norm(ball, axis=1), 0.5, atol=1e-6)


def test_it_is_drawn_in_place_of_the_kinds_picture(tmp_path: Path) -> None:
    appearance = Appearance(file=str(write_stl(tmp_path / "hull.stl", box(1.0, 0.5, 0.5))), color="#ff0000")
    shape = replace(ROV, appearance=appearance)
    assert [message.path for message in draw_vehicle(shape)] == ["/world/vehicle/hull"]
    assert [message.path for message in draw_vehicle(shape, tint=0x0000FF)] == ["/world/vehicle/hull"]
    assert [message.path for message in draw_goal(shape)] == ["/world/goal/ghost", "/world/goal/ball"]
    assert len(draw_vehicle(ROV)) > 1


@pytest.mark.browser
def test_its_colour_is_seen(tmp_path: Path) -> None:
    appearance = Appearance(file=str(write_stl(tmp_path / "hull.stl", box(0.5, 0.5, 0.5))), color="#ff0000")
    with OffscreenViewer(replace(ROV, appearance=appearance), 160, 120, caption=False) as viewer:
        red, green, blue = np.moveaxis(viewer.render(snapshot()).astype(int), 2, 0)
    assert np.mean((red > 2 * green) & (red > 2 * blue)) > 0.01


@pytest.mark.parametrize("content", [b"", b"glTF\x02\0\0\0", b"solid\nendsolid", b"junk" * 100])
@pytest.mark.parametrize("ending", ["stl", "glb"])
def test_what_is_no_mesh_is_refused(tmp_path: Path, content: bytes, ending: str) -> None:
    file = tmp_path / f"hull.{ending}"
    file.write_bytes(content)
    with pytest.raises(InvalidInputError, match=f"hull.{ending}"):
        mesh_of(file)


def test_a_mesh_of_too_many_triangles_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "MOST_TRIANGLES", 11)
    with pytest.raises(InvalidInputError, match="has 12 triangles; give a mesh of 1 to 11"):
        mesh_of(write_stl(tmp_path / "hull.stl", box(1.0, 0.5, 0.5)))


def test_without_the_mesh_the_kind_is_drawn(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    shape = replace(ROV, appearance=Appearance(file=str(tmp_path / "elsewhere.stl")))
    assert len(draw_vehicle(shape)) == len(draw_vehicle(ROV))
    draw_goal(shape)
    said = capfd.readouterr().err
    assert said.count("elsewhere.stl") == 1
    assert "is not there: the vehicle is drawn by its kind" in said


def vehicle_file(folder: Path, table: str) -> Path:
    file = folder / "mine.toml"
    file.write_text(catalogue_file("bluerov2").read_text(encoding="utf-8") + f"\n[appearance]\n{table}\n")
    return file


def test_a_vehicles_file_names_its_mesh_from_where_it_is(tmp_path: Path) -> None:
    (tmp_path / "meshes").mkdir()
    mesh = write_stl(tmp_path / "meshes" / "hull.stl", box(1.0, 0.5, 0.5))
    vehicle = load_vehicle(vehicle_file(tmp_path, 'file = "meshes/hull.stl"\nunit = "cm"'))
    assert vehicle.appearance == Appearance(file=str(mesh.resolve()), unit="cm")
    plain = load_vehicle("bluerov2")
    assert vehicle.model_copy(update={"appearance": None}) == plain, "it has no part in the physics"


@pytest.mark.parametrize(
    ("table", "said"),
    [
        ('file = "missing.stl"', r"appearance.file = 'missing.stl': there is no"),
        ('file = "hull.obj"', r"appearance.file.*'\.obj'.*give a mesh in STL or GLB"),
        ('file = "hull.stl"\naxes = "fld"', r"appearance.axes.*right-handed"),
        ('file = "hull.stl"\naxes = "xyz"', r"appearance.axes"),
        ('file = "hull.stl"\ncolor = "red"', r"appearance.color"),
        ('file = "hull.stl"\nunit = "mile"', r"appearance.unit"),
        ("file = 3", r"appearance.file"),
    ],
)
def test_wrong_tables_are_told(tmp_path: Path, table: str, said: str) -> None:
    write_stl(tmp_path / "hull.stl", box(1.0, 0.5, 0.5))
    (tmp_path / "hull.obj").write_text("v 0 0 0\n")
    with pytest.raises(VehicleFileError, match=said):
        load_vehicle(vehicle_file(tmp_path, table))
