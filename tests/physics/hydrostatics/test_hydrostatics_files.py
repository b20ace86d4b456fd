"""What vehicle files say of floating: read, converted and refused."""

import numpy as np
import pytest

from dq_marine.errors import VehicleFileError
from dq_marine.physics.hydrostatics.flotation import cells_of
from dq_marine.physics.hydrostatics.restoring import heave_period, restoring_modes
from dq_marine.physics.hydrostatics.tables import HullBox
from dq_marine.simulation.scene import Scene
from dq_marine.vehicles import load_vehicle, vehicle_sheet
from dq_marine.vehicles.loading import _FOLDER

TEXT = (_FOLDER / "otter.toml").read_text()


def edited(tmp_path, old, new):
    assert TEXT.count(old) >= 1
    path = tmp_path / "my.toml"
    path.write_text(TEXT.replace(old, new, 1))
    return path


AREA = "waterplane_area = 0.75 "
WRONG = {
    "neither": (AREA, "# ", "hydrostatics", "waterplane_area"),
    "both": (AREA, "stiffness = [7000.0, 900.0, 2700.0]\n" + AREA, "hydrostatics.stiffness", "say it too"),
    "unknown key": (AREA, "gm = 1\n" + AREA, "hydrostatics.gm", "unknown key"),
    "negative area": (AREA, "waterplane_area = -0.75 ", "waterplane_area", "greater than 0"),
    "top-heavy": ("transverse = 1.2325", "transverse = -0.1", "does not right itself", "hull"),
    "area in cm^2": (AREA, "waterplane_area = 7500.0 ", "waterplane of 7500 m^2", "m^2"),
    "too light": ("volume = 0.078", "volume = 0.098", "buoyancy.volume", "mass over water_density"),
    "hull in mm": ("size = [2.0, 0.1875, 0.25]", "size = [2000.0, 187.5, 250.0]", "hull", "in m"),
    "flat box": (
        "size = [2.0, 0.1875, 0.25]",
        "size = [2.0, 0.1875, 0.0]",
        "hull.0.size.2",
        "greater than 0",
    ),
    "no cells": ("cells = [16, 2]", "cells = [0, 2]", "hull.0.cells.0", "greater than or equal to 1"),
    "heavy payload": ("mass = 25.0 ", "mass = 2500.0 ", "payloads.0.mass", "rigid_body.mass"),
    "draft in cm": ("draft = 0.195", "draft = 19.5", "dimensions.draft", "in m"),
    "payload adrift": (
        "position = [0.05, 0.0, -0.35]",
        "position = [50.0, 0.0, 0.0]",
        "payloads.0.position",
        "in m",
    ),
}


@pytest.mark.parametrize("case", WRONG)
def test_a_wrong_file_is_refused(tmp_path, case):
    old, new, field, remedy = WRONG[case]
    with pytest.raises(VehicleFileError) as caught:
        load_vehicle(edited(tmp_path, old, new))
    assert field in str(caught.value)
    assert remedy in str(caught.value).replace("must not be negative", "greater than or equal to 1")


def test_an_asymmetric_stiffness_is_refused(tmp_path):
    text = (
        TEXT[: TEXT.index(AREA)]
        + "stiffness = [[7541.0, 0.0, 1508.0], [0.0, 967.0, 0.0], [1400.0, 0.0, 2743.0]]\n"
    )
    path = tmp_path / "my.toml"
    path.write_text(text + TEXT[TEXT.index("# The published model's") :])
    with pytest.raises(VehicleFileError, match="not symmetric"):
        load_vehicle(path)


def test_the_flotation_centre_couples_heave_and_pitch(tmp_path):
    """It sinks by z - x_f theta: C_35 = -rho g A x_f, and pitch gains rho g A x_f^2."""
    vehicle = load_vehicle("otter")
    centred = load_vehicle(edited(tmp_path, "center_of_flotation = -0.2", "center_of_flotation = 0.0"))
    gained = vehicle.waterplane_stiffness - centred.waterplane_stiffness
    heave = 1025.0 * 9.81 * 0.75
    assert np.allclose(gained, [[0.0, 0.0, 0.2 * heave], [0.0] * 3, [0.2 * heave, 0.0, 0.04 * heave]])


def test_floating_modes_solve_the_eigenproblem_of_all_axes():
    vehicle = load_vehicle("supply_vessel")
    stiffness = np.zeros((6, 6))
    stiffness[2:5, 2:5] = vehicle.waterplane_stiffness
    frequencies, motions = restoring_modes(vehicle)
    for frequency, motion in zip(frequencies, motions, strict=True):
        inertial = frequency**2 * vehicle.mass_matrix @ motion
        assert np.allclose(inertial, stiffness @ motion, atol=1e-9 * np.abs(inertial).max())


def test_heave_is_told_of_vessels_only():
    assert vehicle_sheet(load_vehicle("tanker")).heave_period == pytest.approx(10.7, abs=0.05)
    assert heave_period(load_vehicle("remus100")) == float("inf")
    assert vehicle_sheet(load_vehicle("remus100")).as_dict()["heave_period"] is None


def test_cells_are_nearly_square_and_about_as_many_as_said():
    for size in ((2.0, 0.25, 0.3), (83.0, 18.0, 8.0), (1.0, 1.0, 1.0), (0.1, 5.0, 1.0)):
        along, across = cells_of(HullBox(position=(0.0, 0.0, 0.0), size=size))
        assert 64 <= along * across <= 130
    assert cells_of(HullBox(position=(0.0, 0.0, 0.0), size=(1.0, 1.0, 1.0), cells=(3, 2))) == (3, 2)


def test_a_scene_with_hull_travels_as_its_arguments():
    scene = Scene("otter", hydrostatics="hull", step=0.01)
    rebuild, arguments = scene.__reduce__()
    again = rebuild(*arguments)
    assert again.hydrostatics == "hull"
    assert again.composition == scene.composition
