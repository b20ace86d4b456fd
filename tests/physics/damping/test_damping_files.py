"""Couplings, cross-flow drag and blended damping in vehicle files: read, refused, and what follows for REMUS 100."""

import re

import numpy as np
import pytest
from support.fossen import blended_drag, coriolis, strip_drag

from dq_marine.errors import InvalidInputError, VehicleFileError
from dq_marine.physics.damping.build import vehicle_damping
from dq_marine.physics.damping.cross_flow_table import CrossFlow, hoerner_drag_coefficient
from dq_marine.physics.matrices import spatial
from dq_marine.simulation.scene import Scene
from dq_marine.vehicles import load_vehicle, vehicle_sheet
from dq_marine.vehicles.loading import _FOLDER
from dq_marine.vehicles.model import MOTIONS

TEXT = re.sub(r"(?s)\ncouplings = \[.*?\n\]\n", "\n", (_FOLDER / "bluerov2_heavy.toml").read_text())
"""BlueROV2 Heavy without the lift of its file."""
COUPLING = '[[damping.couplings]]\nforce = "sway"\nspeed = "surge"\nvelocity = "sway"\ncoefficient = 28.6\n'
STRIPS = '[[cross_flow]]\nplane = "sway"\nlength = 0.4\ndepth = 0.2\ndrag_coefficient = 0.9\n'
BLEND = '[[damping.blended]]\naxis = "surge"\nlinear = 20.0\nquadratic = 150.0\ncrossover = 0.5\n'


def extended(tmp_path, *tables):
    path = tmp_path / "my.toml"
    path.write_text("\n".join([TEXT, *tables]))
    return path


def test_a_coupling_is_an_entry_of_the_tensor(tmp_path):
    vehicle = load_vehicle(extended(tmp_path, COUPLING))
    tensor = np.zeros((6, 6, 6))
    tensor[1, 1, 0] = 28.6
    assert np.array_equal(vehicle.damping_couplings, tensor)
    assert Scene(vehicle).terms[-1] == "damping couplings"
    assert not vehicle.signed_damping_couplings.any()
    assert not load_vehicle(extended(tmp_path)).damping_couplings.any()


def test_a_signed_coupling_is_an_entry_of_a_tensor_of_its_own(tmp_path):
    signed = COUPLING.replace('force = "sway"', 'force = "yaw"') + "signed = true\n"
    vehicle = load_vehicle(extended(tmp_path, COUPLING, signed))
    tensor = np.zeros((6, 6, 6))
    tensor[5, 1, 0] = 28.6
    assert np.array_equal(vehicle.signed_damping_couplings, tensor)
    assert np.count_nonzero(vehicle.damping_couplings) == 1
    assert [one.name for one in vehicle.damping.couplings] == ["sway by |surge| sway", "yaw by surge sway"]


@pytest.mark.parametrize("plane", ["sway", "heave"])
def test_a_vehicles_strips_drag_as_written(tmp_path, plane):
    """(1/2) rho depth C_D |v_i| v_i dx at the middle of each strip, in the vehicle's water or the table's own."""
    table = STRIPS.replace("sway", plane) + "center = 0.05\nstrips = 8\nwater_density = 1026.0\n"
    vehicle = load_vehicle(extended(tmp_path, table))
    term = vehicle_damping(vehicle)
    nu = np.array([0.4, -0.7, 0.3, 0.2, -1.5, 2.5])
    algebra = term.algebra
    drag = algebra.apply(algebra.at(term.matrices, spatial(nu)), spatial(nu))
    own = vehicle.linear_damping @ nu + vehicle.quadratic_damping * np.abs(nu) * nu
    row = (0.5 * 1026.0 * 0.2 * 0.9 * 0.05, 0.05 - 0.2 + 0.025, 0.05, 8)
    assert np.allclose([*drag.linear, *drag.angular], own + strip_drag(plane, *row, nu), rtol=1e-13)
    assert Scene(vehicle).terms[-1] == "cross-flow drag"
    assert CrossFlow(plane="sway", length=1.0, depth=2.0, drag_coefficient=0.5).strip_coefficient(
        1000.0
    ) == pytest.approx(25.0, rel=1e-15)


def test_published_strips_on_both_ends_are_one_more_and_longer():
    """`x = -L/2; for i in range(21): ...; x += L/20` with strips of L/20 each."""
    drag = CrossFlow(plane="sway", length=2.1, depth=0.195, drag_coefficient=0.9, strips=21)
    assert np.allclose(drag.levers, np.linspace(-1.0, 1.0, 21), rtol=0, atol=1e-15)
    assert drag.strip_coefficient(1026.0) == pytest.approx(0.5 * 1026.0 * 0.195 * 0.9 * 0.1, rel=1e-14)


def test_hoerners_curve_goes_through_its_points_and_stays_level_beyond():
    assert hoerner_drag_coefficient(0.9880) == 0.8284
    assert hoerner_drag_coefficient(4.0031) == hoerner_drag_coefficient(10.0) == 0.5593
    assert hoerner_drag_coefficient(1e-3) == 1.9661
    between = hoerner_drag_coefficient(0.5 * (1.3081 + 1.6392))
    assert between == pytest.approx(0.5 * (0.7599 + 0.6914), rel=1e-14)
    ratios = np.linspace(0.001, 5.0, 500)
    assert (np.diff([hoerner_drag_coefficient(ratio) for ratio in ratios]) <= 0.0).all()
    by_beam = CrossFlow(plane="sway", length=1.0, depth=0.2, beam=0.3)
    given = CrossFlow(plane="sway", length=1.0, depth=0.2, drag_coefficient=hoerner_drag_coefficient(0.75))
    assert by_beam.strip_coefficient(1000.0) == given.strip_coefficient(1000.0)
    for wrong in (0.0, -1.0, float("nan")):
        with pytest.raises(InvalidInputError, match="beam_over_twice_draft"):
            hoerner_drag_coefficient(wrong)


@pytest.mark.parametrize("axis", [1, 2, 4, 5])
def test_the_sheets_terminal_speed_knows_the_strips(tmp_path, axis):
    plane = "sway" if axis in (1, 5) else "heave"
    vehicle = load_vehicle(extended(tmp_path, STRIPS.replace("sway", plane)))
    speed = vehicle_sheet(vehicle).terminal_speed[MOTIONS[axis]]
    assert speed < vehicle_sheet(load_vehicle("bluerov2_heavy")).terminal_speed[MOTIONS[axis]]
    nu = np.zeros(6)
    nu[axis] = speed
    width = 0.4 / 20
    row = (0.5 * 1000.0 * 0.2 * 0.9 * width, -0.2 + 0.5 * width, width, 20)
    drag = vehicle.linear_damping @ nu + vehicle.quadratic_damping * nu**2 + strip_drag(plane, *row, nu)
    assert drag[axis] == pytest.approx(vehicle.wrench_limits[axis], rel=1e-12)


def test_the_sheets_terminal_speed_knows_blends(tmp_path):
    """In surge both parts count, in yaw the linear one: there is no way on."""
    vehicle = load_vehicle(extended(tmp_path, BLEND + BLEND.replace("surge", "yaw").replace("150.0", "0.0")))
    speeds = vehicle_sheet(vehicle).terminal_speed
    for axis, quadratic in ((0, 150.0), (5, 0.0)):
        nu = np.zeros(6)
        nu[axis] = speeds[MOTIONS[axis]]
        own = vehicle.linear_damping @ nu + vehicle.quadratic_damping * nu**2
        drag = own + blended_drag(axis, 20.0, quadratic, 0.5, nu)
        assert drag[axis] == pytest.approx(vehicle.wrench_limits[axis], rel=1e-12)
    assert (
        vehicle_sheet(vehicle).terminal_speed["sway"]
        == vehicle_sheet(load_vehicle("bluerov2_heavy")).terminal_speed["sway"]
    )
    at_rest = np.diag(vehicle.damping_at_rest - vehicle.linear_damping)
    assert at_rest == pytest.approx([20.0, 0.0, 0.0, 0.0, 0.0, 20.0], abs=1e-12)


WRONG = {
    "blend twice": (BLEND * 2, "damping.blended.1.axis", "one entry for each axis"),
    "blend of nothing": (BLEND.replace("20.0", "0.0").replace("150.0", "0.0"), "damping.blended.0", "leave it out"),
    "blend that falls": (BLEND.replace("20.0", "9e3"), "damping.blended.0", "a smaller linear damping"),
    "blend without crossover": (BLEND.replace("0.5", "0.0"), "damping.blended.0.crossover", "greater than 0"),
    "unknown axis": (COUPLING.replace('"surge"', '"ahead"'), "damping.couplings.0.speed", "'surge'"),
    "no coefficient": (COUPLING.replace("coefficient = 28.6", ""), "damping.couplings.0.coefficient", "missing"),
    "not finite": (COUPLING.replace("28.6", "inf"), "damping.couplings.0.coefficient", "finite"),
    "derivative's sign": (COUPLING.replace("28.6", "-28.6"), "damping.couplings.0.coefficient", "feeds energy in"),
    "signed along its own velocity": (COUPLING + "signed = true\n", "damping.couplings.0.signed", "leave signed out"),
    "twice": (COUPLING * 2, "damping.couplings.1", "with the sum"),
    "one axis": (COUPLING.replace("surge", "sway"), "damping.couplings.0", "damping.quadratic[1]"),
    "no drag": (STRIPS.replace("drag_coefficient = 0.9", ""), "cross_flow.0", "give drag_coefficient, or beam"),
    "two drags": (STRIPS + "beam = 0.3", "cross_flow.0", "one of the two"),
    "drag of nothing real": (STRIPS.replace("0.9", "9.0"), "cross_flow.0.drag_coefficient", "less than or equal to 5"),
    "negative drag": (STRIPS.replace("0.9", "-0.9"), "cross_flow.0.drag_coefficient", "greater than 0"),
    "no strips": (STRIPS + "strips = 0", "cross_flow.0.strips", "greater than 0"),
    "half a strip": (STRIPS + "strips = 1.5", "cross_flow.0.strips", "integer"),
    "plane": (STRIPS.replace("sway", "surge"), "cross_flow.0.plane", "'heave'"),
    "length in mm": (STRIPS.replace("length = 0.4", "length = 400.0"), "cross_flow.0.length", "in m"),
    "depth in mm": (STRIPS.replace("depth = 0.2", "depth = 200.0"), "cross_flow.0.depth", "in m"),
    "centre in mm": (STRIPS + "center = 50.0", "cross_flow.0.center", "in m"),
    "density in g/cm^3": (STRIPS + "water_density = 1.026", "cross_flow.0.water_density", "kg/m^3"),
}  # fmt: skip


@pytest.mark.parametrize("mistake", WRONG)
def test_a_wrong_file_is_refused(tmp_path, mistake):
    tables, field, remedy = WRONG[mistake]
    with pytest.raises(VehicleFileError) as caught:
        load_vehicle(extended(tmp_path, tables))
    assert field in str(caught.value)
    assert remedy in str(caught.value)


# The catalogue's AUVs

# Sgarioto (2006), over his 1.543 m/s: totals of added mass and lift, in body axes.
# Force, velocity, coefficient of u times the velocity.
REMUS = {
    "Y_uv": (1, 1, -43.4055), "Z_uw": (2, 2, -43.4055), "N_uv": (5, 1, -4.47 / 1.543), "M_uw": (4, 2, 4.47 / 1.543),
    "Y_ur": (1, 5, 2.2 / 1.543), "Z_uq": (2, 4, -2.2 / 1.543), "M_uq": (4, 4, -4.45003), "N_ur": (5, 5, -4.45003),
}  # fmt: skip

# Healey & Lienard (1993), made dimensional with 1025 kg/m^3 and 5.3 m: powers of L for forces by velocities, forces by
# rates and moments by velocities, moments by rates.
FORCE, MIXED, MOMENT = (0.5 * 1025.0 * 5.3**power for power in (2, 3, 4))
NPS = {
    "Y_uv": (1, 1, -0.1 * FORCE), "Z_uw": (2, 2, -0.3 * FORCE), "Y_up": (1, 3, 3e-3 * MIXED),
    "Y_ur": (1, 5, 3e-2 * MIXED), "Z_uq": (2, 4, -0.14 * MIXED), "K_uv": (3, 1, 3.1e-3 * MIXED),
    "M_uw": (4, 2, 0.1 * MIXED), "N_uv": (5, 1, -7.4e-3 * MIXED), "K_up": (3, 3, -1.1e-2 * MOMENT),
    "K_ur": (3, 5, -8.4e-4 * MOMENT), "M_uq": (4, 4, -6.8e-2 * MOMENT), "N_up": (5, 3, -8.4e-4 * MOMENT),
    "N_ur": (5, 5, -1.6e-2 * MOMENT),
}  # fmt: skip


@pytest.mark.parametrize(("name", "published"), [("remus100", REMUS), ("npsauv", NPS)])
def test_added_mass_and_lift_together_are_the_published(name, published):
    """The first from Kirchhoff's equations with M_A, by differences; so nothing is counted twice."""
    vehicle = load_vehicle(name)
    added = np.array(vehicle.added_mass)
    ahead = np.array([1.0, 0.0, 0.0, 0.0, 0.0, 0.0])

    def wrench(nu):
        lift = np.einsum("ij,j->i", vehicle.damping_couplings[:, :, 0] * abs(nu[0]), nu)
        return -coriolis(added, nu) @ nu - lift

    totals = np.column_stack([(wrench(ahead + e) - wrench(ahead - e)) / 2.0 for e in np.eye(6)])
    expected = np.zeros((6, 6))
    for force, velocity, value in published.values():
        expected[force, velocity] = value
    assert np.allclose(totals[:, 1:], expected[:, 1:], rtol=2e-5, atol=1e-9)


def growth_on_course(vehicle, couplings, speed):
    """Growth rate of sway and yaw about steady motion ahead, without roll [1/s]."""
    m = vehicle.mass_matrix

    def wrench(nu):
        drag = vehicle.quadratic_damping * np.abs(nu) * nu + np.einsum(
            "ijk,j,k->i", couplings, nu, np.abs(nu)
        )
        return -coriolis(m, nu) @ nu - drag

    ahead = np.array([speed, 0.0, 0.0, 0.0, 0.0, 0.0])
    width = 1e-6
    slopes = [(wrench(ahead + d) - wrench(ahead - d)) / (2.0 * width) for d in width * np.eye(6)]
    both = np.ix_([1, 5], [1, 5])
    return float(np.linalg.eigvals(np.linalg.solve(m[both], np.column_stack(slopes)[both])).real.max())


def test_lift_makes_the_nps_auv_stable_on_course():
    vehicle = load_vehicle("npsauv")
    for speed in (0.5, 1.9):
        assert growth_on_course(vehicle, vehicle.damping_couplings, speed) < 0.0
        assert growth_on_course(vehicle, np.zeros((6, 6, 6)), speed) > 0.0


def test_lift_makes_remus_stable_on_course():
    """Fins fixed. The criterion Y_v N_r > N_v (Y_r - m) of Sgarioto (2006) is met, 193 against 84; not Prestero's."""
    vehicle = load_vehicle("remus100")
    m = vehicle.mass_matrix[np.ix_([1, 5], [1, 5])]
    bare = growth_on_course(vehicle, np.zeros((6, 6, 6)), 1.5)
    lifted = growth_on_course(vehicle, vehicle.damping_couplings, 1.5)
    published = 1.5 * np.array([[-43.4055, 2.2 / 1.543 - vehicle.rigid_body.mass], [-4.47 / 1.543, -4.45003]])
    assert lifted == pytest.approx(np.linalg.eigvals(np.linalg.solve(m, published)).real.max(), abs=1e-4)
    assert lifted < 0.0 < bare


def test_the_lift_acts_against_the_flow_astern_as_ahead():
    """By |u|: the side force of a drift changes sign with the drift alone."""
    couplings = load_vehicle("remus100").damping_couplings
    for surge in (1.5, -1.5):
        nu = np.array([surge, 0.1, 0.2, 0.0, 0.0, 0.0])
        force = -np.einsum("ijk,j,k->i", couplings, nu, np.abs(nu))
        assert force[1] == pytest.approx(-43.4055 * 1.5 * 0.1)
        assert force[2] == pytest.approx(-43.4055 * 1.5 * 0.2)
