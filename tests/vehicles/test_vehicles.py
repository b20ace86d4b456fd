"""Vehicle files: what is read, and what is refused, with file, field, value and remedy."""

import numpy as np
import pytest

from dq_marine.errors import InvalidInputError, VehicleFileError
from dq_marine.vehicles import Vehicle, load_vehicle, vehicle_names
from dq_marine.vehicles.loading import _FOLDER

TEXT = (_FOLDER / "bluerov2_heavy.toml").read_text()


def edited(tmp_path, old, new):
    assert TEXT.count(old) >= 1
    path = tmp_path / "my.toml"
    path.write_text(TEXT.replace(old, new, 1))
    return path


@pytest.mark.parametrize("name", vehicle_names())
def test_every_catalogue_vehicle_is_physical(name):
    vehicle = load_vehicle(name)
    m = vehicle.mass_matrix
    assert np.allclose(m, m.T)
    assert np.linalg.eigvalsh(m).min() > 0.0
    assert vehicle.sources
    assert load_vehicle(vehicle) is vehicle


def test_bluerov2_heavy_has_the_published_numbers():
    """Von Benzon et al. 2022, table of parameters."""
    vehicle = load_vehicle("bluerov2_heavy")
    assert np.allclose(
        np.diag(vehicle.mass_matrix),
        np.add((13.5, 13.5, 13.5, 0.26, 0.23, 0.37), (6.3567, 7.1206, 18.6863, 0.1858, 0.1348, 0.2215)),
    )
    assert vehicle.weight == pytest.approx(13.5 * 9.81)
    assert vehicle.buoyant_force == pytest.approx(13.4 * 9.81)
    assert np.allclose(vehicle.restoring_arm, (0.0, 0.0, 13.4 * 9.81 * 0.01))
    assert np.allclose(np.diag(vehicle.linear_damping), (13.7, 0.0, 33.0, 0.0, 0.8, 0.0))


def test_a_users_file_is_taken(tmp_path):
    path = edited(tmp_path, "mass = 13.5", "mass = 14.5")
    assert load_vehicle(path).rigid_body.mass == 14.5
    assert load_vehicle(str(path)).rigid_body.mass == 14.5


def test_an_offset_centre_of_mass_couples_surge_and_pitch(tmp_path):
    """M_RB about CO has -m S(r_G) (Fossen 2021, ch. 3): z_G > 0 couples X with q as +m z_G."""
    vehicle = load_vehicle(
        edited(tmp_path, "center_of_mass = [0.0, 0.0, 0.0]", "center_of_mass = [0.0, 0.0, 0.02]")
    )
    m = vehicle.rigid_body_matrix
    assert m[0, 4] == pytest.approx(13.5 * 0.02)
    assert m[1, 3] == pytest.approx(-13.5 * 0.02)
    assert m[4, 4] == pytest.approx(0.23 + 13.5 * 0.02**2)
    # Kinetic energy of any motion is that of the mass points' motion: (1/2) m |v_G|^2 + (1/2) omega I_G omega
    nu = np.array([0.3, -0.2, 0.5, 0.7, -0.4, 0.2])
    at_com = nu[:3] + np.cross(nu[3:], (0.0, 0.0, 0.02))
    energy = 0.5 * 13.5 * at_com @ at_com + 0.5 * nu[3:] @ np.diag([0.26, 0.23, 0.37]) @ nu[3:]
    assert 0.5 * nu @ m @ nu == pytest.approx(energy)


WRONG = {
    "unknown key": ("[dimensions]", "[dimensions]\ncolour = 'blue'", "dimensions.colour", "unknown key"),
    "unknown table": ("[limits]", "[engine]\n[limits]", "engine", "unknown key"),
    "missing key": ("volume = 0.0134", "", "buoyancy.volume", "missing"),
    "wrong shape": ("inertia = [0.26, 0.23, 0.37]", "inertia = [0.26, 0.23]", "rigid_body.inertia", "3 numbers"),
    "ragged matrix": ("inertia = [0.26, 0.23, 0.37]", "inertia = [[1, 0], [0, 1], [0, 0]]", "inertia", "3 rows"),
    "negative mass": ("mass = 13.5", "mass = -13.5", "rigid_body.mass = -13.5", "greater than 0"),
    "NaN": ("volume = 0.0134", "volume = nan", "buoyancy.volume", "finite"),
    "infinity": ("mass = 13.5", "mass = inf", "rigid_body.mass", "finite"),
    "text": ("mass = 13.5", "mass = 'heavy'", "rigid_body.mass", "not a number"),
    "mass in grams": ("mass = 13.5", "mass = 13500.0", "rigid_body.mass", "kg"),
    "volume in litres": ("volume = 0.0134", "volume = 13.4", "rigid_body.mass", "m^3"),
    "length in millimetres": ("length = 0.457", "length = 457.0", "dimensions", "in m"),
    "inertia in kg cm^2": ("inertia = [0.26, 0.23, 0.37]", "inertia = [2600.0, 2300.0, 3700.0]", "inertia", "kg m^2"),
    "no body's inertia": ("inertia = [0.26, 0.23, 0.37]", "inertia = [0.2, 0.2, 0.9]", "inertia", "sum of the other"),
    "derivatives' sign": ("added_mass = [6.3567", "added_mass = [-6.3567", "added_mass", "write minus them"),
    "damping's sign": ("linear = [13.7", "linear = [-13.7", "damping.linear", "feeds energy in"),
    "quadratic sign": ("quadratic = [141.0", "quadratic = [-141.0", "damping.quadratic", "negative"),
    "no actuation": ("[113.0, 113.0, 160.0, 34.9, 19.2, 30.2]", "[0, 0, 0, 0, 0, 0]", "limits", "axis"),
    "limits in kN m": ("wrench = [113.0", "wrench = [113000000.0", "limits.wrench", "in N"),
    "centre in mm": ("center = [0.0, 0.0, -0.01]", "center = [0.0, 0.0, -10.0]", "buoyancy.center", "in m"),
    "density in g/cm^3": ("water_density = 1000.0", "water_density = 1.0", "mass", "kg/m^3"),
    "shape": ('shape = "open_frame"', 'shape = "banana"', "dimensions.shape", "open_frame"),
    "zero direction": ("direction = [1.0, -1.0, 0.0]", "direction = [0.0, 0.0, 0.0]", "thrusters.0", "zero vector"),
    "not TOML": ("[limits]", "[limits", "not a TOML file", "line"),
}  # fmt: skip


@pytest.mark.parametrize("mistake", WRONG)
def test_a_wrong_file_is_refused(tmp_path, mistake):
    old, new, field, remedy = WRONG[mistake]
    path = edited(tmp_path, old, new)
    with pytest.raises(VehicleFileError) as caught:
        load_vehicle(path)
    message = str(caught.value)
    assert str(path) in message
    assert field in message
    assert remedy in message


def asymmetric(off, mirrored):
    rows = np.diag([6.3567, 7.1206, 18.6863, 0.1858, 0.1348, 0.2215])
    rows[0, 4], rows[4, 0] = off, mirrored
    return "added_mass = " + repr(rows.tolist())


LINE = next(line for line in TEXT.splitlines() if line.startswith("added_mass"))


def test_asymmetry_is_refused_beyond_and_accepted_within_tolerance(tmp_path):
    with pytest.raises(VehicleFileError, match=r"not symmetric.*symmetric part"):
        load_vehicle(edited(tmp_path, LINE, asymmetric(0.5, 0.4)))
    vehicle = load_vehicle(edited(tmp_path, LINE, asymmetric(0.5, 0.5 + 1e-9)))
    assert np.array_equal(vehicle.mass_matrix, vehicle.mass_matrix.T)


def test_a_published_asymmetry_is_accepted_if_it_is_said(tmp_path):
    """And then it is the symmetric part that is used."""
    path = edited(tmp_path, LINE, asymmetric(0.5, 0.45))
    with pytest.raises(VehicleFileError, match=r"say so with added_mass_asymmetry = 0\.019,"):
        load_vehicle(path)
    vehicle = load_vehicle(edited(tmp_path, LINE, f"{asymmetric(0.5, 0.45)}\nadded_mass_asymmetry = 0.019"))
    assert vehicle.mass_matrix[0, 4] == vehicle.mass_matrix[4, 0] == pytest.approx(0.475)
    with pytest.raises(VehicleFileError, match=r"more than 0\.018"):
        load_vehicle(edited(tmp_path, LINE, f"{asymmetric(0.5, 0.45)}\nadded_mass_asymmetry = 0.018"))
    with pytest.raises(VehicleFileError, match=r"less than or equal to 0\.1"):
        load_vehicle(edited(tmp_path, LINE, f"{LINE}\nadded_mass_asymmetry = 0.5"))


def test_an_indefinite_mass_matrix_is_refused(tmp_path):
    with pytest.raises(VehicleFileError, match="not positive definite"):
        load_vehicle(edited(tmp_path, LINE, asymmetric(5.0, 5.0)))


@pytest.mark.parametrize("value", [3, None, ["bluerov2_heavy"]])
def test_what_is_no_vehicle_is_refused(value):
    with pytest.raises(InvalidInputError, match="catalogue name"):
        load_vehicle(value)


@pytest.mark.parametrize("value", ["bluerov3", "nowhere/my.toml"])
def test_a_missing_vehicle_names_what_there_is(value):
    with pytest.raises(InvalidInputError, match="bluerov2_heavy"):
        load_vehicle(value)


def test_a_vehicle_is_frozen():
    vehicle = load_vehicle("bluerov2_heavy")
    with pytest.raises(ValueError, match="frozen"):
        vehicle.name = "mine"  # type: ignore[misc]
    assert isinstance(vehicle, Vehicle)
