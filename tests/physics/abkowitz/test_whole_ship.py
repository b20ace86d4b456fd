"""Ships by polynomials about their service speed: against mariner.m written apart, and beyond where they are known."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from support.fossen import coriolis
from support.lanes import assert_actuated_lanes_equal_singles
from support.mariner import CENTER, DENSITY, INERTIA, LENGTH, MASS, SERVICE_SPEED, Mariner
from support.order import observed_order

from dq_marine.algebra.dual_quaternion import pose_from_parts
from dq_marine.algebra.spatial import from_fossen, to_fossen
from dq_marine.errors import InvalidInputError
from dq_marine.physics.abkowitz.build import rudder_term, whole_ship_terms
from dq_marine.physics.abkowitz.formulas.ship import ship_motion
from dq_marine.physics.actuators.allocation import ThrustAllocator
from dq_marine.simulation.scene import Scene
from dq_marine.vehicles import load_vehicle
from dq_marine.vehicles.validation import validated

POSE = pose_from_parts((1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
PLANE = [0, 1, 5]
FULL = math.radians(40.0)
MARINER = load_vehicle("mariner")


def changed(change):
    content = MARINER.model_dump()
    change(content)
    return validated(content, "test")


def ship(scale=1.0):
    """The Mariner with all digits, all in one plane, by Froude's law at another size."""
    mass, length = 0.5 * DENSITY * (scale * LENGTH) ** 3, scale * LENGTH
    content = MARINER.model_dump()
    _, _, heave, roll, pitch, _ = np.diag(content["added_mass"])
    added = np.diag(
        [
            42e-5 * mass,
            748e-5 * mass,
            heave * scale**3,
            roll * scale**5,
            pitch * scale**5,
            43.8e-5 * mass * length**2,
        ]
    )
    added[1, 5] = added[5, 1] = -0.5 * (-9.354e-5 + 4.646e-5) * mass * length
    about_com = (INERTIA - MASS * CENTER**2) * mass * length**2
    content["added_mass"], content["added_mass_asymmetry"] = added.tolist(), 0.0
    content["rigid_body"] |= {
        "mass": MASS * mass,
        "center_of_mass": (CENTER * length, 0.0, 0.0),
        "inertia": (1.464e9 * scale**5, about_com, about_com),
    }
    x, y, z = content["buoyancy"]["center"]
    content["buoyancy"] |= {"volume": MASS * mass / DENSITY, "center": (scale * x, y, scale * z)}
    content["hydrostatics"]["waterplane_area"] *= scale**2
    for name in ("metacentric_height_transverse", "metacentric_height_longitudinal"):
        content["hydrostatics"][name] *= scale
    for name in ("length", "width", "height", "draft"):
        content["dimensions"][name] *= scale
    content["whole_ship"] |= {
        "length": length,
        "service_speed": SERVICE_SPEED * math.sqrt(scale),
        "depth": 0.0,
    }
    return validated(content, "test")


def wrench_of(vehicle, nu, rudder=0.0):
    """X to N of hull and rudder, in Fossen's order."""
    (hull,), twist = whole_ship_terms(vehicle), from_fossen(tuple(nu))
    own = rudder_term(vehicle.whole_ship, vehicle.buoyancy.water_density)
    wrench = np.array(to_fossen(hull.function(hull.parameters, POSE, twist, 0.0)))
    return wrench + to_fossen(own.wrench(own.numbers, (rudder, ()), twist))


def acceleration(vehicle, nu, rudder):
    """Rate of the velocity in Fossen's order: M nu' + C(nu) nu = the wrench of hull and rudder."""
    m = vehicle.mass_matrix
    return np.linalg.solve(m, wrench_of(vehicle, nu, rudder) - coriolis(m, np.array(nu)) @ nu)


def known_motion(rng):
    """u, v, r within what the polynomials know, and a rudder angle to starboard."""
    u = rng.uniform(5.0, 9.0)
    v, r = u * rng.uniform(-0.4, 0.4), rng.uniform(-0.75, 0.75) * u / LENGTH
    return (u, v, 0.0, 0.0, 0.0, r), rng.uniform(-FULL, FULL)


def test_accelerations_are_those_of_the_published_equations():
    """With the full M and its centripetal and Munk terms on the left, to round-off."""
    vehicle, model, rng = ship(), Mariner(symmetric=True), np.random.default_rng(1)
    for _ in range(200):
        nu, rudder = known_motion(rng)
        own = acceleration(vehicle, nu, rudder)
        u, v, *_, r = nu
        expected = np.array(model.rates(u, v, r, -rudder))
        assert own[PLANE] == pytest.approx(expected, rel=1e-11, abs=1e-15)
        assert not own[2:5].any()


def test_the_file_has_the_published_numbers():
    exact = ship()
    for vehicle in (MARINER, exact):
        assert vehicle.mass_matrix[np.ix_(PLANE, PLANE)] == pytest.approx(
            0.5
            * DENSITY
            * LENGTH**3
            * np.array(
                [
                    [840e-5, 0.0, 0.0],
                    [0.0, 1546e-5, (-0.023 * 798e-5 + 2.354e-5) * LENGTH],
                    [0.0, (-0.023 * 798e-5 + 2.354e-5) * LENGTH, 83.0e-5 * LENGTH**2],
                ]
            ),
            rel=2e-5,
        )
    assert MARINER.whole_ship.model_dump(exclude={"depth"}) == exact.whole_ship.model_dump(exclude={"depth"})
    assert MARINER.weight == pytest.approx(MARINER.buoyant_force, rel=1e-6)


def test_a_turn_goes_to_that_of_the_equations_integrated_by_scipy_with_the_square_of_the_step():
    """All six degrees of freedom, hull, rudder and its lag, and its rate at first."""
    model, vehicle, duration = Mariner(symmetric=True), ship(), 300.0
    *place, heading, u, v, r, angle = model.held(model.start(), -FULL, duration).y[:, -1]
    steps, errors = np.array([0.4, 0.2, 0.1, 0.05]), []
    for step in steps:
        body = Scene(vehicle, step=step, actuation="thrusters").stepper()
        body.reset(velocity_body=(SERVICE_SPEED, 0.0, 0.0, 0.0, 0.0, 0.0))
        body.actuate((FULL,), round(duration / step))
        w, _, _, z = body.quaternion_body_to_ned
        turned = math.remainder(2.0 * math.atan2(z, w) - heading, 2.0 * math.pi)
        motion = (body.velocity_body[PLANE] - (u, v, r)) * (1.0, 1.0, LENGTH)
        errors.append(np.linalg.norm([*(body.position_ned[:2] - place), LENGTH * turned, *motion]))
        assert body.get_state()[15] == pytest.approx(-angle, rel=1e-8)
        assert abs(body.position_ned[2]) < 1e-9  # nothing heels, trims or lifts it
        assert np.abs(body.velocity_body[2:5]).max() < 1e-12
    assert abs(observed_order(steps, errors) - 2.0) < 0.05
    assert errors[-1] < 2e-4 * LENGTH


@pytest.mark.sweep
def test_lanes_have_the_bits_of_single_ships():
    scene, rng, count = Scene(MARINER, step=0.1, actuation="thrusters"), np.random.default_rng(2), 9
    velocities = rng.normal(0.0, (5.0, 1.0, 0.1, 0.01, 0.01, 0.02), (count, 6))
    assert_actuated_lanes_equal_singles(scene, velocities, rng.uniform(-FULL, FULL, (count, 1)), 40)


@pytest.mark.sweep
def test_a_current_is_what_the_ship_moves_through():
    """In a uniform current everything drifts along."""
    ends = []
    for current in ((0.0, 0.0, 0.0), (0.6, -0.4, 0.0)):
        body = Scene(ship(), step=0.1, actuation="thrusters", current=current).stepper()
        body.reset(velocity_body=(7.0 + current[0], current[1], 0.0, 0.0, 0.0, 0.0))
        body.actuate((0.3,), 1000)
        ends.append((body.position_ned - 100.0 * np.array(current), body.relative_velocity_body))
    assert ends[0][0] == pytest.approx(ends[1][0], abs=1e-8)
    assert ends[0][1] == pytest.approx(ends[1][1], abs=1e-9)


def test_a_larger_ship_moves_by_froudes_law():
    small, large, scale, rng = ship(), ship(3.0), 3.0, np.random.default_rng(3)
    root = math.sqrt(scale)
    for _ in range(100):
        nu, rudder = known_motion(rng)
        scaled = np.array(nu) * (root, root, root, 1.0 / root, 1.0 / root, 1.0 / root)
        own, expected = acceleration(large, scaled, rudder), acceleration(small, nu, rudder)
        assert own == pytest.approx(expected / (1.0, 1.0, 1.0, scale, scale, scale), rel=1e-11, abs=1e-16)


wild = st.tuples(st.floats(-30.0, 30.0), st.floats(-20.0, 20.0), st.floats(-0.2, 0.2), st.floats(-FULL, FULL))


def even_hull(content):
    """Without what one propeller does to one side: the constants of Y' and N', and what goes with them."""
    for name in ("sway", "yaw"):
        content["whole_ship"][name] = {
            letters: value
            for letters, value in content["whole_ship"][name].items()
            if set(letters) & set("vrd")
        }


@given(wild)
def test_a_ship_that_is_the_same_on_both_sides_does_the_mirror_image_of_what_it_does(motion):
    u, v, r, rudder = motion
    ours = wrench_of(EVEN, (u, v, 0.0, 0.0, 0.0, r), rudder)
    image = wrench_of(EVEN, (u, -v, 0.0, 0.0, 0.0, -r), -rudder)
    assert np.array_equal(image, ours * (1.0, -1.0, 1.0, -1.0, 1.0, -1.0))


EVEN = changed(even_hull)


def other_sign(content):
    """The same ship by derivatives whose rudder angle is positive to starboard."""
    tables = content["whole_ship"]
    tables["rudder"]["positive_to"] = "starboard"
    for name in ("surge", "sway", "yaw"):
        tables[name] = {
            letters: value * (-1.0) ** letters.count("d") for letters, value in tables[name].items()
        }


@given(wild)
def test_the_sign_of_published_rudder_angles_is_a_convention(motion):
    u, v, r, rudder = motion
    nu = (u, v, 0.0, 0.0, 0.0, r)
    assert np.array_equal(wrench_of(OTHER_SIGN, nu, rudder), wrench_of(MARINER, nu, rudder))


OTHER_SIGN = changed(other_sign)


@given(wild)
def test_polynomials_are_evaluated_at_what_they_know(motion):
    """Within it, at the motion itself; beyond, at its edge, without a jump."""
    u, v, r, rudder = motion
    (hull,) = whole_ship_terms(MARINER)
    own = hull.parameters.ship
    at = ship_motion(own, from_fossen((u, v, 0.0, 0.0, 0.0, r)), rudder)
    known, room = own.range, 1.0 + 1e-12
    assert -known.loss * room <= at.surge <= known.gain * room
    assert abs(at.sway) <= known.drift * room
    assert abs(at.yaw) <= known.turn * room
    speed = math.hypot(u, v)
    change, drift, turn = (
        (x / speed if speed > 1e-6 else math.inf) for x in (u - SERVICE_SPEED, v, r * LENGTH)
    )
    if -known.loss < change < known.gain and abs(drift) < known.drift and abs(turn) < known.turn:
        assert (at.speed, at.surge, at.sway, at.yaw) == pytest.approx((speed, change, drift, turn), rel=1e-12)
    near = np.array(wrench_of(MARINER, (u + 1e-9, v, 0.0, 0.0, 0.0, r), rudder))
    here = wrench_of(MARINER, (u, v, 0.0, 0.0, 0.0, r), rudder)
    assert np.abs((near - here)[:2]).max() < 1.0  # of 1e5 N and more
    assert abs((near - here)[5]) < LENGTH


def test_from_any_motion_it_comes_back_to_what_its_propeller_holds():
    """Spun, thrown sideways or astern at up to four times its speed, with the rudder anywhere."""
    body, rng = Scene(MARINER, step=0.1, actuation="thrusters").stepper(), np.random.default_rng(4)
    for _ in range(20):
        direction = rng.normal(size=3)
        u, v, turn = 4.0 * SERVICE_SPEED * direction / np.linalg.norm(direction)
        body.reset(velocity_body=(u, v, 0.0, 0.0, 0.0, turn / LENGTH))
        rudder = rng.uniform(-FULL, FULL)
        body.actuate((rudder,), 20_000)
        ahead, aside, *_, rate = body.velocity_body
        assert 0.75 * SERVICE_SPEED < math.hypot(ahead, aside) < 1.001 * SERVICE_SPEED
        assert abs(math.atan2(aside, ahead)) < math.radians(10.0)
        assert abs(rate) * LENGTH / SERVICE_SPEED < 0.3


def test_it_heels_outward_in_a_turn_and_little():
    """By m U r times half the draft and the height of its centre of mass over W GM, to first order."""
    body = Scene(MARINER, step=0.1, actuation="thrusters").stepper()
    body.reset((0.0, 0.0, MARINER.equilibrium_depth), velocity_body=(SERVICE_SPEED, 0.0, 0.0, 0.0, 0.0, 0.0))
    body.actuate((FULL,), 10_000)
    w, x, y, z = body.quaternion_body_to_ned
    roll = math.atan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y))
    u, _, _, _, _, r = body.velocity_body
    added, rigid = MARINER.added_mass_matrix, MARINER.rigid_body.mass
    force = (rigid + added[0, 0]) * u * r
    righting = MARINER.weight * MARINER.hydrostatics.metacentric_height_transverse
    assert roll == pytest.approx(-3.735 * force / righting, rel=0.03)


def test_thrust_is_not_allocated_to_a_ship_whose_propeller_is_in_polynomials():
    with pytest.raises(InvalidInputError, match="command its channels"):
        ThrustAllocator(MARINER)


def test_what_a_file_says_is_read_back():
    """A constant among the derivatives, and letters in any order."""
    assert validated(MARINER.model_dump(), "test") == MARINER
    other = changed(lambda c: c["whole_ship"]["sway"].update(rvv=c["whole_ship"]["sway"].pop("vvr")))
    assert other.whole_ship == MARINER.whole_ship
    assert hash(other) == hash(MARINER)
    assert list(other.whole_ship.sway) == list(MARINER.whole_ship.sway)


def mmg(content):
    content["manoeuvring"] = load_vehicle("kvlcc2").manoeuvring.model_dump()


def damped(content):
    content["damping"]["quadratic"] = (0.0, 1e5, 0.0, 0.0, 0.0, 0.0)


def linearly_damped(content):
    content["damping"]["linear"] = np.diag([1e5, 0.0, 1e7, 7e7, 2e10, 0.0]).tolist()


def lifted(content):
    content["damping"]["couplings"] = [
        {"force": "yaw", "speed": "surge", "velocity": "sway", "coefficient": 1e6}
    ]


def blended(content):
    content["damping"]["blended"] = [{"axis": "surge", "linear": 1e4, "quadratic": 1e4, "crossover": 1.0}]


def dragged(content):
    content["cross_flow"] = [{"plane": "sway", "length": 160.0, "depth": 7.0, "drag_coefficient": 1.0}]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (mmg, r"whole_ship = together with \[manoeuvring\].*one of the two"),
        (
            damped,
            r"damping.quadratic.1 = 100000: the polynomials of whole_ship have the damping.*leave it out",
        ),
        (linearly_damped, r"damping.linear = 100000 in surge: the polynomials.*leave it out"),
        (lifted, r"damping.couplings.0 = yaw by sway: the polynomials.*leave it out"),
        (blended, r"damping.blended.0 = damping in surge: the polynomials.*leave it out"),
        (dragged, r"cross_flow.0 = drag in sway and yaw: the polynomials.*leave it out"),
        (lambda c: c["whole_ship"].update(length=1609.3), r"whole_ship.length = 1609.3.*give both in m"),
        (lambda c: c["whole_ship"].update(depth=20.0), r"whole_ship.depth = 20.*positive down"),
        (
            lambda c: c["whole_ship"].update(service_speed=100.0),
            r"whole_ship.service_speed = 100.*not in knots",
        ),
        (
            lambda c: c["whole_ship"]["rudder"].update(positive_to="starboard"),
            r"whole_ship.yaw.d = -0.00139: a positive angle.*to starboard.*check the sign",
        ),
        (lambda c: c["whole_ship"]["yaw"].pop("d"), r"whole_ship.yaw.d = 0.*check the sign"),
        (
            lambda c: c["whole_ship"]["surge"].update({"0": 1e-4}),
            r"whole_ship.surge.0 = 0.0001.*leave it out",
        ),
        (
            lambda c: c["whole_ship"]["surge"].update(u=2e-3),
            r"whole_ship.surge = .*not driven ahead.*X'_u is negative",
        ),
        (lambda c: c["whole_ship"]["sway"].update(v=0.1), r"whole_ship.sway = .*drive sway.*check the signs"),
        (lambda c: c["whole_ship"]["yaw"].update(r=0.1), r"whole_ship.yaw = .*drive yaw.*check the signs"),
        (
            lambda c: c["whole_ship"]["yaw"].update(v=-264.0),
            r"whole_ship.yaw = .*'v' is -264, beyond 10, as no derivative is.*1e-5",
        ),
        (
            lambda c: c["whole_ship"]["yaw"].update(w=1e-3),
            r"whole_ship.yaw = .*'w' is no derivative.*letters u, v, r, d",
        ),
        (lambda c: c["whole_ship"]["yaw"].update(rvv=1e-3), r"whole_ship.yaw = .*there twice.*their sum"),
        (lambda c: c["whole_ship"]["yaw"].update(r=math.nan), r"whole_ship.yaw.r = nan: not a finite number"),
        (lambda c: c["whole_ship"]["range"].update(drift_deg=80.0), r"whole_ship.range.drift_deg = 80.*45"),
    ],
)
def test_files_that_are_wrong(change, message):
    with pytest.raises(InvalidInputError, match=f"(?s){message}"):
        changed(change)
