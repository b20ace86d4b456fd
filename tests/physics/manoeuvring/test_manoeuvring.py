"""Ships by the MMG model: against its equations written apart, against shipmmg, and beyond where polynomials hold."""

import math

import numpy as np
import pytest
from support.fossen import coriolis
from support.lanes import assert_actuated_lanes_equal_singles
from support.mmg import KvlccModel, gaussian_wake, turning_figures
from support.order import observed_order
from support.sweeps import sweep

from dq_marine.algebra.dual_quaternion import pose_from_parts
from dq_marine.algebra.spatial import from_fossen, to_fossen
from dq_marine.errors import InvalidInputError
from dq_marine.physics.actuators.allocation import ThrustAllocator
from dq_marine.physics.manoeuvring.build import hull_numbers, manoeuvring_terms, stern_term
from dq_marine.physics.manoeuvring.formulas.hull import manoeuvring_hull
from dq_marine.simulation.scene import Scene
from dq_marine.vehicles import load_vehicle
from dq_marine.vehicles.validation import validated

SHAFT = 11.8516 * 2.0 * math.pi  # rad/s: holds 1.179 m/s
FULL = math.radians(35.0)
UPRIGHT = (1.0, 0.0, 0.0, 0.0)
POSE = pose_from_parts(UPRIGHT, (0.0, 0.0, 0.0))

# A balanced turn of 35 degrees by shipmmg 0.0.11 (pip install shipmmg==0.0.11): u0 = 1.179 m/s, n = 11.8516 1/s, rudder
# 15.8 degrees/s, rho = 1025 kg/m^3, its own numbers of KVLCC2 L-7 with m = 3.27 rho and x_P = -0.690:
# simulate_mmg_3dof(basic, manoeuvring, t, rudder, n, u0=1.179, method="RK45", rtol=1e-9, atol=1e-11).
# Advance, transfer, tactical diameter [L], U/U0, r [degrees/s], drift angle [degrees].
SHIPMMG = {
    1: (3.065, 1.291, 3.017, 0.3692, 3.192, 19.30),
    -1: (2.919, 1.172, 2.754, 0.3405, -3.332, -20.46),
}


def ship(wake="two_constants", **manoeuvring):
    """KVLCC2 L-7 with all digits, all in one plane: no force heels or trims it."""
    content, model = load_vehicle("kvlcc2_l7").model_dump(), KvlccModel()
    _, _, heave, roll, pitch, _ = np.diag(content["added_mass"])
    content["added_mass"] = (model.mx, model.my, heave, roll, pitch, model.jz)
    content["rigid_body"] |= {"mass": model.m, "inertia": (865.0, model.iz, model.iz)}
    tables = content["manoeuvring"] | manoeuvring
    tables["hull"] |= {"depth": 0.0}
    tables["propeller"] |= {"depth": 0.0}
    tables["rudder"] |= {"depth": 0.0}
    if wake == "gaussian":
        tables["propeller"] |= {"wake": {"form": "gaussian", "straight": 0.40}, "position": -0.690}
    content["rigid_body"]["center_of_mass"] = (0.25, 0.0, 0.0)
    return validated(content | {"manoeuvring": tables}, "test")


def reference(wake):
    return KvlccModel(gaussian_wake, -0.690) if wake == "gaussian" else KvlccModel()


def acceleration(vehicle, nu, delta, n):
    """Rate of the velocity in Fossen's order: M nu' + C(nu) nu = the wrench of hull and stern."""
    twist = from_fossen(nu)
    stern = stern_term(vehicle.manoeuvring, vehicle.buoyancy.water_density)
    (hull,) = manoeuvring_terms(vehicle)
    wrench = np.array(to_fossen(hull.function(hull.parameters, POSE, twist, 0.0)))
    wrench += to_fossen(stern.wrench(stern.numbers, (2.0 * math.pi * n, (delta, ())), twist))
    m = vehicle.mass_matrix
    return np.linalg.solve(m, wrench - coriolis(m, np.array(nu)) @ nu)


@pytest.mark.parametrize("wake", ["two_constants", "gaussian"])
def test_accelerations_are_those_of_the_mmg_equations(wake):
    """With the full M and its Munk moment on the left, to round-off."""
    vehicle, model, rng = ship(wake), reference(wake), np.random.default_rng(1)
    for _ in range(200):
        speed, drift, turn = rng.uniform(0.2, 2.0), rng.uniform(-0.6, 0.6), rng.uniform(-1.4, 1.4)
        u, v, r = speed * math.cos(drift), -speed * math.sin(drift), turn * speed / 7.0
        delta, n = rng.uniform(-FULL, FULL), rng.uniform(5.0, 15.0)
        own = acceleration(vehicle, (u, v, 0.0, 0.0, 0.0, r), delta, n)
        expected = np.array(model.rates(u, v, r, delta, n))
        assert np.abs(own[[0, 1, 5]] - expected).max() < 1e-13 * max(1.0, np.abs(expected).max())
        assert not own[2:5].any()


def moving(body, speed=1.179):
    """Place a body on its straight course with the shaft turning."""
    body.reset(velocity_body=(speed, 0.0, 0.0, 0.0, 0.0, 0.0))
    state = body.get_state()
    state[15] = SHAFT
    body.set_state(state)


def turned(vehicle, side, *, step=0.05, duration=200.0):
    """x, y, psi, u, v, r, roll and depth of a turn, sampled at each step."""
    body = Scene(vehicle, step=step, actuation="thrusters").stepper()
    moving(body)
    rows, headings = [], []
    for _ in range(round(duration / step)):
        body.actuate((SHAFT, side * FULL))
        w, x, y, z = body.quaternion_body_to_ned
        headings.append(math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z)))
        roll = math.atan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y))
        rows.append((*body.position_ned[:2], *body.velocity_body[[0, 1, 5]], roll, body.position_ned[2]))
    columns = np.array(rows).T
    return np.vstack([columns[:2], np.unwrap(headings), columns[2:]])


def figures(states):
    """As `SHIPMMG` has them."""
    _, _, _, u, v, r = states[:6, -1]
    steady = (math.hypot(u, v) / 1.179, math.degrees(r), math.degrees(math.atan2(-v, u)))
    return (*turning_figures(states, 7.0), *steady)


@pytest.mark.parametrize("wake", sweep(["two_constants", "gaussian"], plain=["gaussian"]))
def test_a_turn_is_that_of_the_equations_integrated_by_scipy(wake):
    states = turned(ship(wake), 1, step=0.02, duration=60.0)
    _, expected = reference(wake).turn(35.0, duration=60.0)
    assert states[:6, -1] == pytest.approx(expected[:, -1], rel=1e-4)
    assert not states[6:].any()  # nothing heels, trims or lifts it


@pytest.mark.parametrize("side", [1, -1])
def test_kvlcc2_turns_like_that_of_shipmmg(side):
    """Within 3 per cent; shipmmg takes speed and drift angle 0.25 m behind midship, which makes 0.3 per cent."""
    assert figures(turned(ship("gaussian"), side)) == pytest.approx(SHIPMMG[side], rel=0.03)


# First and second overshoot of the same ship by shipmmg, rtol 1e-9 [degrees]: side, angle.
OVERSHOOTS = {(1, 20): (10.48, 15.11), (-1, 20): (13.52, 11.65), (1, 10): (4.893, 13.07)}


@pytest.mark.parametrize(("side", "angle"), OVERSHOOTS)
def test_kvlcc2_overshoots_like_that_of_shipmmg(side, angle):
    body = Scene(ship("gaussian"), step=0.02, actuation="thrusters").stepper()
    moving(body)
    helm, reached, found = side, False, []
    while len(found) < 2 and body.time < 100.0:
        body.actuate((SHAFT, helm * math.radians(angle)))
        w, _, _, z = body.quaternion_body_to_ned
        heading = math.degrees(2.0 * math.atan2(z, w))
        if helm * heading >= angle:
            helm, reached = -helm, True
        if reached and helm * body.velocity_body[5] > 0.0:
            found.append(abs(heading) - angle)
            reached = False
    assert found == pytest.approx(OVERSHOOTS[side, angle], rel=0.03)


@pytest.mark.parametrize("side", [1, -1])
def test_the_equations_written_apart_are_those_of_shipmmg(side):
    """With its point of reference, to its printed digits: the reference of these tests is one that others share."""
    _, states = KvlccModel(gaussian_wake, -0.690, drift_at=-0.25).turn(35.0 * side)
    assert figures(states) == pytest.approx(SHIPMMG[side], rel=4e-4)


def test_shipmmg_itself_still_says_so():
    """Run live where it is installed: rates of one motion of a turn, by its own code."""
    shipmmg = pytest.importorskip("shipmmg.mmg_3dof")
    rho, length, d = 1025.0, 7.0, 0.46
    m, k = 3.27 * rho, 0.5 * rho * length**2 * d
    basic = shipmmg.Mmg3DofBasicParams(
        L_pp=length, B=1.27, d=d, x_G=0.25, D_p=0.216, m=m, I_zG=m * (0.25 * length) ** 2, A_R=0.0539,
        η=0.216 / 0.345, m_x=0.022 * k, m_y=0.223 * k, J_z=0.011 * k * length**2, f_α=2.747, ϵ=1.09, t_R=0.387,
        x_R=-0.5 * length, a_H=0.312, x_H=-0.464 * length, γ_R_minus=0.395, γ_R_plus=0.640, l_R=-0.710, κ=0.50,
        t_P=0.220, w_P0=0.40, x_P=-0.690,
    )  # fmt: skip
    own = shipmmg.Mmg3DofManeuveringParams(
        k_0=0.2931, k_1=-0.2753, k_2=-0.1385, R_0_dash=0.022, X_vv_dash=-0.040, X_vr_dash=0.002, X_rr_dash=0.011,
        X_vvvv_dash=0.771, Y_v_dash=-0.315, Y_r_dash=0.083, Y_vvv_dash=-1.607, Y_vvr_dash=0.379, Y_vrr_dash=-0.391,
        Y_rrr_dash=0.008, N_v_dash=-0.137, N_r_dash=-0.049, N_vvv_dash=-0.030, N_vvr_dash=-0.294, N_vrr_dash=0.055,
        N_rrr_dash=-0.013,
    )  # fmt: skip
    times = np.linspace(0.0, 200.0, 4001)
    rudder = np.minimum(np.radians(15.8) * times, FULL)
    solution = shipmmg.simulate_mmg_3dof(
        basic, own, times, rudder, np.full_like(times, 11.8516), u0=1.179, rtol=1e-9, atol=1e-11
    )
    u, v, r, x, y, psi = solution.sol(times)[:6]
    assert figures(np.array([x, y, psi, u, v, r])) == pytest.approx(SHIPMMG[1], rel=4e-4)


@pytest.mark.sweep
def test_the_order_is_kept():
    """The rudder held, a turn that is under way: everything is smooth there."""
    vehicle, counts = ship(), np.array([10, 20, 40, 80])
    start = (0.9, -0.2, 0.0, 0.0, 0.0, 0.05)

    def end(count):
        body = Scene(vehicle, step=4.0 / count, actuation="thrusters").stepper()
        body.reset(velocity_body=start)
        state = body.get_state()
        state[15:17] = SHAFT, 0.3
        body.set_state(state)
        body.actuate((SHAFT, 0.3), count)
        return np.array([*body.position_ned[:2], *body.velocity_body[[0, 1, 5]]])

    finest = end(1280)
    errors = [np.linalg.norm(end(int(count)) - finest) for count in counts]
    assert abs(observed_order(4.0 / counts, errors) - 2.0) < 0.05


@pytest.mark.sweep
def test_lanes_have_the_bits_of_single_ships():
    vehicle, rng, count = load_vehicle("kvlcc2_l7"), np.random.default_rng(2), 9
    velocities = rng.normal(0.0, (1.0, 0.3, 0.05, 0.05, 0.02, 0.2), (count, 6))
    commands = rng.uniform((0.0, -FULL), (SHAFT, FULL), (count, 2))
    assert_actuated_lanes_equal_singles(
        Scene(vehicle, step=0.05, actuation="thrusters"), velocities, commands, 40
    )


def hull_wrench(vehicle, u, v, r):
    numbers = hull_numbers(vehicle, vehicle.manoeuvring)._replace(munk=0.0, skew=0.0)
    wrench = to_fossen(manoeuvring_hull(numbers, POSE, from_fossen((u, v, 0.0, 0.0, 0.0, r)), 0.0))
    return np.array(wrench)[[0, 1, 5]]


def test_a_hull_resists_whatever_it_does():
    """Ahead, astern, sideways, on the spot: it takes energy, and astern it is the mirror image of itself."""
    vehicle, rng = ship(), np.random.default_rng(3)
    for _ in range(500):
        nu = rng.normal(0.0, 1.0, 3) * 10.0 ** rng.uniform(-3.0, 1.0, 3) * (1.0, 1.0, 0.2)
        wrench = hull_wrench(vehicle, *nu)
        assert wrench @ nu < 0.0
        astern = hull_wrench(vehicle, -nu[0], nu[1], -nu[2])
        assert astern == pytest.approx(
            wrench * (-1.0, 1.0, -1.0), rel=1e-12, abs=1e-12 * np.abs(wrench).max()
        )
    assert not hull_wrench(vehicle, 0.0, 0.0, 0.0).any()


def test_a_hull_is_continued_without_a_jump():
    vehicle = ship()
    for limit in (math.radians(40.0), math.radians(90.0)):
        sides = [hull_wrench(vehicle, math.cos(a), -math.sin(a), 0.02) for a in (limit - 1e-9, limit + 1e-9)]
        assert sides[0] == pytest.approx(sides[1], rel=1e-6, abs=1e-6)
    fast = [
        hull_wrench(vehicle, 1.0, 0.1, r * math.hypot(1.0, 0.1) * 1.5 / 7.0) for r in (1.0 - 1e-9, 1.0 + 1e-9)
    ]
    assert fast[0] == pytest.approx(fast[1], rel=1e-6)


@pytest.mark.sweep
def test_a_current_is_what_the_ship_moves_through():
    """In a uniform current everything drifts along."""
    ends = []
    for current in ((0.0, 0.0, 0.0), (0.3, -0.2, 0.0)):
        body = Scene(ship(), step=0.05, actuation="thrusters", current=current).stepper()
        body.reset(velocity_body=(1.179 + current[0], current[1], 0.0, 0.0, 0.0, 0.0))
        body.actuate((SHAFT, 0.3), 400)
        ends.append((body.position_ned - 20.0 * np.array(current), body.relative_velocity_body))
    assert ends[0][0] == pytest.approx(ends[1][0], abs=1e-9)
    assert ends[0][1] == pytest.approx(ends[1][1], abs=1e-9)


def test_both_ships_heel_little_and_turn_like_ships():
    """The catalogue's, with all six degrees of freedom: 2 to 4.5 lengths, drift below 30 degrees, roll below 15."""
    states = turned(load_vehicle("kvlcc2_l7"), 1)
    _, _, diameter, _, _, drift = figures(states)
    assert 2.0 < diameter < 4.5
    assert abs(drift) < 30.0
    assert 0.1 < math.degrees(np.abs(states[6]).max()) < 15.0
    flat = figures(turned(ship(), 1))
    assert figures(states) == pytest.approx(flat, rel=0.01)


def test_the_files_have_the_published_numbers():
    for name, scale in (("kvlcc2_l7", 1.0), ("kvlcc2", 320.0 / 7.0)):
        vehicle, model = load_vehicle(name), KvlccModel(scale=scale)
        added, rigid = np.diag(vehicle.added_mass_matrix), vehicle.rigid_body
        assert (added[0], added[1], added[5]) == pytest.approx((model.mx, model.my, model.jz), rel=0.015)
        assert (rigid.mass, rigid.inertia[2][2]) == pytest.approx((model.m, model.iz), rel=0.002)
    vehicle, model = load_vehicle("kvlcc2_l7"), KvlccModel()
    added, rigid = np.diag(vehicle.added_mass_matrix), vehicle.rigid_body
    published = (model.mx, model.my, model.jz, model.m, model.iz)
    assert (added[0], added[1], added[5], rigid.mass, rigid.inertia[2][2]) == pytest.approx(
        published, rel=1e-7
    )


def test_full_scale_runs_like_the_model_by_froudes_law():
    model, full = load_vehicle("kvlcc2_l7").manoeuvring, load_vehicle("kvlcc2").manoeuvring
    scale = full.length / model.length
    assert full.hull.model_dump(exclude={"depth"}) == model.hull.model_dump(exclude={"depth"})
    assert full.propeller.speed_limit * math.sqrt(scale) == pytest.approx(
        model.propeller.speed_limit, rel=1e-6
    )
    for part, name, power in (("propeller", "diameter", 1), ("rudder", "height", 1), ("rudder", "area", 2)):
        own, small = (getattr(getattr(tables, part), name) for tables in (full, model))
        assert own == pytest.approx(small * scale**power, rel=0.003)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda c: c["manoeuvring"].update(length=70.0), r"manoeuvring.length.*70.*give both in m"),
        (lambda c: c["manoeuvring"].update(draft=4.6), r"manoeuvring.draft.*4.6.*give both in m"),
        (
            lambda c: c["manoeuvring"]["rudder"].update(position=0.5),
            r"manoeuvring.rudder.position.*negative aft",
        ),
        (lambda c: c["manoeuvring"]["hull"]["yaw"].update(r=0.1), r"manoeuvring.hull.yaw.*check the signs"),
        (lambda c: c["manoeuvring"]["hull"]["sway"].update(v=1.5), r"manoeuvring.hull.sway.*check the signs"),
        (lambda c: c["manoeuvring"]["propeller"]["wake"].update(straight=1.2), "less than 1"),
        (lambda c: c["manoeuvring"]["propeller"]["wake"].update(form="other"), "two_constants"),
    ],
)
def test_files_that_are_wrong(change, message):
    content = load_vehicle("kvlcc2_l7").model_dump()
    change(content)
    with pytest.raises(InvalidInputError, match=f"(?s){message}"):
        validated(content, "test")


def test_a_drifting_hull_has_the_yaw_moment_of_its_polynomial_whatever_its_added_mass():
    """Without turning, the Munk moment of any M cancels."""
    content, rng = ship().model_dump(), np.random.default_rng(4)
    matrix = np.array(content["added_mass"])
    for (i, j), value in {(0, 1): 40.0, (0, 5): 60.0, (1, 5): -300.0}.items():
        matrix[i, j] = matrix[j, i] = value
    coupled = validated(content | {"added_mass": matrix.tolist()}, "test")
    (hull,) = manoeuvring_terms(coupled)
    for u, v in rng.normal(0.0, 1.0, (50, 2)):
        nu = np.array([u, v, 0.0, 0.0, 0.0, 0.0])
        wrench = np.array(to_fossen(hull.function(hull.parameters, POSE, from_fossen(nu), 0.0)))
        total = wrench - coriolis(coupled.mass_matrix, nu) @ nu
        assert total[5] == pytest.approx(hull_wrench(coupled, u, v, 0.0)[2], rel=1e-11, abs=1e-10)


def test_thrust_is_not_allocated_to_a_stern():
    with pytest.raises(InvalidInputError, match="command its channels"):
        ThrustAllocator(load_vehicle("kvlcc2_l7"))
