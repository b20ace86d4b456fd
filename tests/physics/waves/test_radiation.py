"""Added mass and damping by frequency: read from a file beside a vehicle's, refused where wrong, felt in a sea."""

import shutil
from pathlib import Path

import numpy as np
import pytest

import dq_marine.vehicles
from dq_marine.errors import VehicleFileError
from dq_marine.physics.waves.floating import HEADINGS, Radiation, long_wave_rao, radiation_of
from dq_marine.physics.weather import Jonswap, Sea, WaveLoads
from dq_marine.vehicles import load_vehicle
from dq_marine.vehicles.validation import validated

CATALOGUE = Path(dq_marine.vehicles.__file__).parent / "catalogue"


def test_the_supply_vessel_has_the_published_tables():
    """Three numbers of MSS, HYDRO/vessels_shipx/supply, and what any such table must be."""
    table = load_vehicle("supply_vessel").radiation
    added, damping = np.array(table.added_mass), np.array(table.damping)
    assert len(table.frequencies) == 36
    assert (added[0, 0, 0], added[0, 1, 3], damping[0, 2, 2]) == pytest.approx(
        (846253.18, 4202437.5, 1456624.9)
    )
    symmetric = 0.5 * (damping + damping.transpose(0, 2, 1))
    lowest, highest = (np.linalg.eigvalsh(symmetric)[:, k] for k in (0, -1))
    assert (lowest > -1e-2 * highest).all()  # radiation takes energy, but for the asymmetry of strip theory
    # Port and starboard are alike: surge, heave and pitch do not go with sway, roll and yaw.
    assert not added[:, 0::2][:, :, 1::2].any()
    assert not damping[:, 1::2][:, :, 0::2].any()


def test_a_sea_is_felt_by_the_table():
    vessel = load_vehicle("supply_vessel")
    sea = Sea(Jonswap(height=2.0, period=9.0))
    stiffness = vessel.waterplane_stiffness
    by_table = long_wave_rao(sea, vessel, stiffness, radiation_of(vessel)).transfer
    constant = np.broadcast_to(np.array(vessel.added_mass), (1, 6, 6)), vessel.linear_damping[None]
    by_constants = long_wave_rao(sea, vessel, stiffness, Radiation(np.array([1.0]), *constant)).transfer
    ahead = int(np.argmin(np.abs(HEADINGS)))
    # More added mass in heave at these frequencies than at infinity: less force, while waves are long.
    assert (np.abs(by_table[:5, ahead, 2]) < np.abs(by_constants[:5, ahead, 2])).all()
    default = WaveLoads(sea).terms(vessel, np.zeros(3))[0].parameters
    given = WaveLoads(sea, radiation=radiation_of(vessel)).terms(vessel, np.zeros(3))[0].parameters
    assert default == given


@pytest.fixture
def files(tmp_path):
    for name in ("supply_vessel.toml", "supply_vessel_radiation.csv"):
        shutil.copy(CATALOGUE / name, tmp_path)
    return tmp_path / "supply_vessel.toml", tmp_path / "supply_vessel_radiation.csv"


def test_a_users_file_names_its_table(files):
    vehicle, _ = files
    assert load_vehicle(vehicle) == load_vehicle("supply_vessel")
    assert validated(load_vehicle(vehicle).model_dump(), "a copy") == load_vehicle("supply_vessel")


@pytest.mark.parametrize(
    ("was", "becomes", "message"),
    [
        ("frequency,force", "omega,force", "columns .*frequency.* are missing"),
        (",sway,roll,", ",sway,rol,", "line 4 has {'rol'}; names are surge"),
        ("846253.18", "846 tons", "line 2: could not convert"),
        ("846253.18", "nan", "not a finite number"),
        ("0.1047198,", "-0.1047198,", "greater than 0"),
    ],
)
def test_wrong_tables_are_refused(files, was, becomes, message):
    vehicle, table = files
    table.write_text(table.read_text(encoding="utf-8").replace(was, becomes), encoding="utf-8")
    with pytest.raises(VehicleFileError, match=message):
        load_vehicle(vehicle)


def test_a_missing_table_is_named(files):
    vehicle, table = files
    table.unlink()
    with pytest.raises(VehicleFileError, match=r"radiation = 'supply_vessel_radiation.csv' cannot be read"):
        load_vehicle(vehicle)


def test_frequencies_rise_and_have_a_matrix_each():
    content = load_vehicle("supply_vessel").model_dump()
    table = content["radiation"]
    with pytest.raises(VehicleFileError, match="there are 36 frequencies"):
        validated(content | {"radiation": table | {"damping": table["damping"][:-1]}}, "it", VehicleFileError)
    backwards = table["frequencies"][::-1]
    with pytest.raises(VehicleFileError, match="not rising"):
        validated(content | {"radiation": table | {"frequencies": backwards}}, "it", VehicleFileError)
