"""Drawn vehicles: physical whatever is drawn, within their ranges, the same for the same seed."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from dq_marine.errors import InvalidInputError
from dq_marine.randomisation import Randomisation, randomisation_names, spread_of
from dq_marine.randomisation.congruence import moments_of_inertia, scaled_and_coupled, second_moments
from dq_marine.vehicles import Vehicle, load_vehicle, spheroid, vehicle_names

VEHICLES = {name: load_vehicle(name) for name in vehicle_names()}
FLOATING = sorted(name for name in VEHICLES if VEHICLES[name].hydrostatics is not None)
vehicles = st.sampled_from(sorted(VEHICLES)).map(VEHICLES.get)
submerged = st.sampled_from(sorted(set(VEHICLES) - set(FLOATING))).map(VEHICLES.get)
seeds = st.integers(0, 2**32)


def always(value):
    """A distribution of one number."""
    return {"uniform": (value, value)}


def from_tables(**tables):
    return Randomisation.model_validate(tables)


def about_center_of_mass(vehicle):
    """Moments of inertia about the centre of mass, from the rigid body's matrix."""
    mass, (x, y, z) = vehicle.rigid_body.mass, vehicle.rigid_body.center_of_mass
    s = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return vehicle.rigid_body_matrix[3:, 3:] + mass * s @ s


def assert_physical(vehicle):
    m = vehicle.mass_matrix
    assert np.allclose(m, m.T, rtol=1e-12, atol=0.0)
    assert np.linalg.eigvalsh(m).min() > 0.0
    linear = vehicle.linear_damping
    assert np.linalg.eigvalsh(linear + linear.T).min() >= -1e-9 * np.abs(linear).max()
    assert (vehicle.quadratic_damping >= 0.0).all()
    smallest, middle, largest = np.linalg.eigvalsh(about_center_of_mass(vehicle))
    assert smallest > 0.0
    assert largest <= (smallest + middle) * (1.0 + 1e-9)


# Laws that hold for every draw


@given(vehicles, st.sampled_from(randomisation_names()), seeds)
def test_any_draw_of_any_vehicle_is_physical(vehicle, name, seed):
    assume(name != "lost_thruster" or len(vehicle.thrusters) + len(vehicle.azimuths) > 1)
    drawn = Randomisation.load(name).draw(vehicle, seed)
    assert_physical(drawn)
    assert Vehicle.model_validate(drawn.model_dump()) == drawn


@st.composite
def wide_randomisations(draw):
    """Any tables that are accepted, with factors up to twice and half, and couplings."""

    def factors():
        low, high = sorted((draw(st.floats(0.5, 2.0)), draw(st.floats(0.5, 2.0))))
        kind = draw(st.sampled_from(["uniform", "log_uniform", "normal"]))
        if kind != "normal":
            return {kind: (low, high)}
        return {"normal": (draw(st.floats(low, high)), draw(st.floats(1e-3, 1.0))), "within": (low, high)}

    coupling = st.floats(0.0, 0.15)
    return from_tables(
        rigid_body={
            "mass": factors(),
            "inertia": tuple(factors() for _ in range(3)),
            "inertia_coupling": draw(coupling),
            "center_of_mass": {"uniform": (-0.02, 0.02)},
        },
        buoyancy={"net_weight": {"uniform": (-0.1, 0.1)}, "center": {"uniform": (-0.02, 0.02)}},
        added_mass={"factor": factors(), "coupling": draw(coupling)},
        damping={"linear": factors(), "linear_coupling": draw(coupling), "quadratic": factors()},
        actuators={"wrench": factors(), "thrust": factors(), "fins": factors()},
    )


@given(vehicles, wide_randomisations(), seeds)
def test_any_randomisation_draws_physical_vehicles(vehicle, randomisation, seed):
    drawn = randomisation.draw(vehicle, seed)
    assert_physical(drawn)
    assert ((drawn.wrench_limits > 0.0) == (vehicle.wrench_limits > 0.0)).all()
    assert Randomisation.model_validate(randomisation.model_dump()) == randomisation


@pytest.mark.parametrize("vehicle", VEHICLES.values(), ids=VEHICLES)
def test_an_axis_without_linear_damping_gets_none_by_coupling(vehicle):
    """Ships have polynomials there: of their damping there must be no more."""
    damped = vehicle.linear_damping.any(axis=0)
    drawn = from_tables(damping={"linear_coupling": 0.1}).draw(vehicle, 1).linear_damping
    assert ((drawn != 0.0) == np.outer(damped, damped)).all()


@given(seeds, st.floats(0.0, 0.15))
def test_a_congruence_keeps_the_signs_of_eigenvalues_and_dissipation(seed, coupling):
    rng = np.random.default_rng(seed)
    basis = rng.normal(size=(6, 6))
    signs = rng.choice([-1.0, 1.0], 6)
    matrix = basis @ np.diag(signs) @ basis.T
    shear = rng.uniform(-coupling, coupling, (6, 6)) * (1.0 - np.eye(6))
    arguments = (np.exp(rng.uniform(-1.0, 1.0, 6)), shear, np.exp(rng.uniform(-3.0, 3.0, 6)))
    varied = scaled_and_coupled(matrix, *arguments)
    eigenvalues = np.linalg.eigvalsh(0.5 * (varied + varied.T))
    assert np.count_nonzero(eigenvalues > 0.0) == np.count_nonzero(signs > 0.0)
    turning = basis - basis.T  # skew: takes no energy
    power = scaled_and_coupled(turning, *arguments)
    assert np.abs(power + power.T).max() <= 1e-12 * np.abs(power).max()


@given(st.lists(st.tuples(*[st.floats(-2.0, 2.0)] * 3), min_size=4, max_size=10))
def test_second_moments_are_those_of_the_points(points):
    r = np.array(points)
    inertia = sum(p @ p * np.eye(3) - np.outer(p, p) for p in r)
    assert np.allclose(second_moments(inertia), r.T @ r, atol=1e-9)
    assert np.allclose(moments_of_inertia(r.T @ r), inertia, atol=1e-9)


# What each entry does


@given(seeds)
def test_within_20_percent_varies_mass_added_mass_and_damping_of_a_ballasted_vehicle(seed):
    vehicle = load_vehicle("bluerov2_heavy")
    drawn = Randomisation.load("within_20_percent").draw(vehicle, seed)
    growth = drawn.rigid_body.mass / vehicle.rigid_body.mass
    factors = [growth]
    for name in ("added_mass", "linear_damping", "quadratic_damping"):
        own, other = np.array(getattr(vehicle, name)), np.array(getattr(drawn, name))
        own, other = (np.diag(one) if one.ndim == 2 else one for one in (own, other))
        factors += (other[own != 0.0] / own[own != 0.0]).tolist()
    assert len(factors) > 12
    assert 0.8 <= min(factors) <= max(factors) <= 1.2
    assert drawn.weight == pytest.approx(growth * vehicle.weight)
    assert drawn.buoyant_force == pytest.approx(growth * vehicle.buoyant_force)
    assert np.allclose(drawn.restoring_arm, growth * vehicle.restoring_arm)
    assert (drawn.wrench_limits == vehicle.wrench_limits).all()


@pytest.mark.parametrize("vehicle", VEHICLES.values(), ids=VEHICLES)
def test_nothing_named_changes_nothing(vehicle):
    assert Randomisation().draw(vehicle, 0) == vehicle


@pytest.mark.parametrize("vehicle", VEHICLES.values(), ids=VEHICLES)
def test_the_default_stays_within_its_ranges(vehicle):
    # The tanker's published moments break the triangle inequality by a per cent: those of its draws do not.
    own = moments_of_inertia(second_moments(about_center_of_mass(vehicle)))
    for drawn in Randomisation.load().pool(vehicle, 60):
        assert 0.8 <= drawn.rigid_body.mass / vehicle.rigid_body.mass <= 1.2
        assert (np.abs(np.diag(about_center_of_mass(drawn)) / np.diag(own) - 1.0) <= 0.2 + 1e-9).all()
        added = np.diag(drawn.added_mass) / np.diag(vehicle.added_mass)
        assert (added >= 0.5 - 1e-12).all()
        assert (added <= 1.5 + 1e-12).all()
        heavier = (drawn.weight - drawn.buoyant_force) / drawn.weight
        assert abs(heavier - (vehicle.weight - vehicle.buoyant_force) / vehicle.weight) <= 0.01 + 1e-12
        lever = np.linalg.norm(drawn.restoring_arm) / drawn.weight
        ratio = lever / (np.linalg.norm(vehicle.restoring_arm) / vehicle.weight)
        assert 0.5 - 1e-9 <= ratio <= 2.0 + 1e-9
        assert drawn.dimensions == vehicle.dimensions


def test_added_mass_and_damping_are_drawn_on_both_sides_of_the_nominal():
    vehicle = VEHICLES["bluerov2_heavy"]
    pool = Randomisation.load().pool(vehicle, 400)
    damped = np.diag(vehicle.linear_damping) > 0.0
    for factors in (
        [np.diag(drawn.added_mass) / np.diag(vehicle.added_mass_matrix) for drawn in pool],
        [np.diag(drawn.linear_damping)[damped] / np.diag(vehicle.linear_damping)[damped] for drawn in pool],
        [drawn.quadratic_damping / vehicle.quadratic_damping for drawn in pool],
    ):
        assert (np.min(factors, axis=0) < 0.55).all()
        assert (np.max(factors, axis=0) > 1.45).all()
        # 4 standard deviations of a mean of 400
        assert np.abs(np.mean(factors, axis=0) - 1.0).max() < 0.06


def test_draws_fill_their_ranges():
    masses = [
        drawn.rigid_body.mass / 13.5 for drawn in Randomisation.load().pool(VEHICLES["bluerov2_heavy"], 400)
    ]
    counts, _ = np.histogram(masses, bins=4, range=(0.8, 1.2))
    assert counts.sum() == 400
    assert (np.abs(counts - 100) < 35).all()  # 4 standard deviations of a binomial's 8.7


@pytest.mark.parametrize("name", ["remus100", "bluerov2_heavy"])
def test_the_centre_of_mass_moves_with_the_inertia_about_it(name):
    """Whether the file's inertia is about the body origin (REMUS 100) or the centre of mass (BlueROV2 Heavy)."""
    vehicle = VEHICLES[name]
    drawn = from_tables(rigid_body={"center_of_mass": always(0.01)}).draw(vehicle, 0)
    assert np.allclose(np.subtract(drawn.rigid_body.center_of_mass, vehicle.rigid_body.center_of_mass), 0.01)
    assert np.allclose(about_center_of_mass(drawn), about_center_of_mass(vehicle), rtol=1e-12)


def test_inertia_follows_the_mass_unless_it_is_named():
    vehicle = VEHICLES["rexrov"]
    denser = from_tables(rigid_body={"mass": always(1.5)}).draw(vehicle, 0)
    assert np.allclose(denser.rigid_body_matrix, 1.5 * vehicle.rigid_body_matrix, rtol=1e-12)
    named = from_tables(rigid_body={"mass": always(1.5), "inertia": always(0.9)}).draw(vehicle, 0)
    assert np.allclose(named.rigid_body.inertia, 0.9 * np.array(vehicle.rigid_body.inertia), rtol=1e-12)


def test_added_mass_grows_by_the_root_of_both_factors():
    vehicle = VEHICLES["rexrov"]
    factors = (0.5, 0.6, 0.7, 0.8, 0.9, 1.1)
    drawn = from_tables(added_mass={"factor": [always(factor) for factor in factors]}).draw(vehicle, 0)
    symmetric = 0.5 * (np.array(vehicle.added_mass) + np.array(vehicle.added_mass).T)
    assert np.allclose(drawn.added_mass, symmetric * np.sqrt(np.outer(factors, factors)), rtol=1e-12)


def test_coupling_couples():
    """What was diagonal is not any more, and no correlation is much larger than asked for."""
    vehicle = VEHICLES["bluerov2_heavy"]
    drawn = from_tables(added_mass={"coupling": 0.1}).draw(vehicle, 0)
    scale = np.sqrt(np.diag(vehicle.mass_matrix))
    correlations = (np.array(drawn.added_mass) / np.outer(scale, scale))[np.triu_indices(6, 1)]
    assert (correlations != 0.0).all()
    assert np.abs(correlations).max() < 0.3


@given(submerged, st.floats(0.8, 1.2), st.floats(-0.2, 0.2), seeds)
def test_the_volume_follows_the_mass(vehicle, factor, share, seed):
    tables = {"rigid_body": {"mass": always(factor)}, "buoyancy": {"net_weight": always(share)}}
    drawn = from_tables(**tables).draw(vehicle, seed)
    expected = (vehicle.weight - vehicle.buoyant_force) / vehicle.weight + share
    assert (drawn.weight - drawn.buoyant_force) / drawn.weight == pytest.approx(expected, abs=1e-12)


@given(submerged, st.floats(0.5, 2.0), st.floats(-40.0, 40.0), st.floats(-40.0, 40.0))
def test_a_vehicle_rests_with_the_drawn_list_and_trim(vehicle, lever, roll, pitch):
    """Down, seen from the body at rest, is along W r_G - B r_B: no moment is left, and the attitude is stable."""
    buoyancy = {"righting_lever": always(lever), "list_angle": always(roll), "trim_angle": always(pitch)}
    mass = {"mass": {"uniform": (0.8, 1.2)}, "center_of_mass": {"uniform": (-0.02, 0.02)}}
    drawn = from_tables(rigid_body=mass, buoyancy=buoyancy).draw(vehicle, 1)
    down = Rotation.from_euler("ZYX", [30.0, pitch, roll], degrees=True).inv().apply([0.0, 0.0, 1.0])
    own = np.linalg.norm(vehicle.restoring_arm) / vehicle.weight
    assert np.allclose(drawn.restoring_arm / drawn.weight, lever * own * down, atol=1e-9 * own)


@pytest.mark.parametrize("name", FLOATING)
def test_a_vessel_that_floats_displaces_its_weight(name):
    vehicle = VEHICLES[name]
    tables = {
        "buoyancy": {"net_weight": always(0.1), "righting_lever": always(1.5), "list_angle": always(10.0)}
    }
    drawn = from_tables(rigid_body={"mass": always(1.2)}, **tables).draw(vehicle, 0)
    assert drawn.weight / drawn.buoyant_force == pytest.approx(
        vehicle.weight / vehicle.buoyant_force, rel=1e-12
    )
    assert drawn.buoyancy.center == vehicle.buoyancy.center
    given = vehicle.hydrostatics.stiffness is not None  # then it does not grow with the displaced weight
    growth = np.array([1.0, 1.5, 1.5]) * (1.0 if given else np.array([1.0, 1.2, 1.2]))
    if vehicle.hydrostatics.center_of_flotation in (None, 0.0):
        expected = vehicle.waterplane_stiffness * np.sqrt(np.outer(growth, growth))
        assert np.allclose(drawn.waterplane_stiffness, expected, rtol=1e-12)
    else:  # heave about the centre of flotation pitches
        assert drawn.waterplane_stiffness[1, 1] == pytest.approx(
            growth[1] * vehicle.waterplane_stiffness[1, 1]
        )


def test_couplings_and_strips_vary_with_the_quadratic_damping():
    factors = (0.5, 0.6, 0.7, 0.8, 0.9, 1.0)
    damping = {"quadratic": [always(factor) for factor in factors]}
    vehicle = VEHICLES["remus100"]
    drawn = from_tables(damping=damping).draw(vehicle, 0)
    scale = np.sqrt(np.outer(factors, factors))[:, :, None]
    assert vehicle.damping_couplings.any()
    assert np.allclose(drawn.damping_couplings, vehicle.damping_couplings * scale, rtol=1e-12)
    otter = VEHICLES["otter"]
    strips, own = from_tables(damping=damping).draw(otter, 0).cross_flow, otter.cross_flow
    for varied, nominal in zip(strips, own, strict=True):
        assert varied.strip_coefficient(1025.0) == pytest.approx(0.6 * nominal.strip_coefficient(1025.0))


def test_propellers_and_fins_are_weaker_each_for_itself():
    vehicle = VEHICLES["bluerov2_heavy"]
    drawn = from_tables(actuators={"thrust": {"uniform": (0.5, 0.9)}}).draw(vehicle, 0)
    pairs = list(zip(drawn.actuators.thrusters, vehicle.actuators.thrusters, strict=True))
    ratios = [np.array(one.thrust_range) / own.thrust_range for one, own in pairs]
    assert len(ratios) == 8
    assert all(ratio[0] == pytest.approx(ratio[1]) for ratio in ratios)
    assert len({round(ratio[0], 6) for ratio in ratios}) == 8
    assert all(0.5 <= ratio[0] <= 0.9 for ratio in ratios)
    fins = from_tables(actuators={"fins": always(0.8)}).draw(VEHICLES["remus100"], 0).actuators.fin_matrix
    assert np.allclose(fins, 0.8 * VEHICLES["remus100"].actuators.fin_matrix)


@pytest.mark.parametrize("lost", [1, 3])
def test_so_many_propellers_are_lost_each_as_often_as_another(lost):
    vehicle = VEHICLES["bluerov2_heavy"]
    pool = from_tables(actuators={"lost": lost}).pool(vehicle, 400, 5)
    gains = np.array([[one.thrust_forward or one.gain_forward for one in drawn.thrusters] for drawn in pool])
    own = np.array([one.thrust_forward or one.gain_forward for one in vehicle.thrusters])
    dead = gains < 1e-3 * own
    assert (dead.sum(axis=1) == lost).all()
    assert np.array_equal(gains[~dead], np.broadcast_to(own, gains.shape)[~dead])
    share = lost / len(own)
    assert (np.abs(dead.mean(axis=0) - share) < 5.0 * np.sqrt(share * (1.0 - share) / 400)).all()


def test_a_lost_propeller_gives_nothing_at_speed_either():
    content = VEHICLES["remus100"].model_dump()
    (own,) = content["thrusters"]
    content["thrusters"] = [own | {"name": name} for name in ("port", "starboard")]
    twin = Vehicle.model_validate(content)
    dead, alive = sorted(
        from_tables(actuators={"lost": 1}).draw(twin, 0).thrusters, key=lambda one: one.inflow
    )
    assert own["inflow"] > 0.0
    assert alive.model_dump(exclude={"name"}) == twin.thrusters[0].model_dump(exclude={"name"})
    assert dead.inflow < 1e-3 * own["inflow"]


def test_the_only_propeller_cannot_be_lost():
    with pytest.raises(
        InvalidInputError, match=r"^actuators\.lost = 1, and REMUS 100 has 1 to lose; give a vehicle"
    ):
        from_tables(actuators={"lost": 1}).draw(VEHICLES["remus100"], 0)


def test_a_payload_makes_a_submerged_vehicle_heavier_in_the_water():
    for drawn in Randomisation.load("payload").pool(VEHICLES["bluerov2_heavy"], 50, 0):
        own = VEHICLES["bluerov2_heavy"]
        share = (drawn.weight - drawn.buoyant_force) / drawn.weight
        before = (own.weight - own.buoyant_force) / own.weight
        assert before <= share + 1e-12
        assert share <= before + 0.03 + 1e-12
        assert own.rigid_body.mass <= drawn.rigid_body.mass <= 1.1 * own.rigid_body.mass + 1e-9


# Reproducibility


def test_a_seed_gives_the_same_vehicles():
    vehicle, randomisation = VEHICLES["remus100"], Randomisation.load()
    pool = randomisation.pool(vehicle, 5, seed=3)
    assert randomisation.pool(vehicle, 3, seed=3) == pool[:3]
    assert len({drawn.rigid_body.mass for drawn in (*pool, *randomisation.pool(vehicle, 5, seed=4))}) == 10
    rng = np.random.default_rng(7)
    first, second = randomisation.draw(vehicle, rng), randomisation.draw(vehicle, rng)
    assert first != second
    assert randomisation.draw(vehicle, 7) == first


def test_a_vehicle_changed_in_code_is_taken():
    vehicle = VEHICLES["bluerov2_heavy"]
    limits = vehicle.limits.model_copy(update={"wrench": [50.0, 0.0, 50.0, 0.0, 0.0, 9.0]})
    (drawn,) = Randomisation.load().pool(vehicle.model_copy(update={"limits": limits}), 1)
    assert ((drawn.wrench_limits > 0.0) == (np.array(limits.wrench) > 0.0)).all()


def test_a_vehicle_without_righting_moment_keeps_none():
    drawn = Randomisation.load().draw(spheroid(0.5, 0.125), 0)
    assert np.abs(drawn.restoring_arm).max() < 1e-12 * drawn.weight


def test_the_spread_is_that_of_the_vehicles():
    vehicle = VEHICLES["remus100"]
    pool = Randomisation.load().pool(vehicle, 20)
    spreads = {spread.name: spread for spread in spread_of(vehicle, pool)}
    masses = [drawn.rigid_body.mass for drawn in pool]
    spread = spreads["mass"]
    assert (spread.nominal, spread.least, spread.largest) == (30.48, min(masses), max(masses))
    assert spread.mean == pytest.approx(np.mean(masses))
    assert "terminal speed in surge" in spreads
    assert "terminal speed in sway" not in spreads  # not actuated


# Refusals


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda r, v: r.pool(v, 0), "number of vehicles = 0 is below 1"),
        (lambda r, v: r.pool(v, 10**6), "too large; give one from 1 to 100000"),
        (lambda r, v: r.pool(v, 2, -1), "seed = -1 is below 0; give 0 or more"),
        (lambda r, v: Randomisation.load(3), "is a int; give a name"),
        (
            lambda r, v: from_tables(buoyancy={"volume": always(0.02)}).draw(v, 0),
            r"none of 100 draws .*\n.*mean density is 50\.4 times",
        ),
    ],
)
def test_bad_requests_are_refused(change, message):
    with pytest.raises(InvalidInputError, match=message):
        change(Randomisation.load(), VEHICLES["bluerov2_heavy"])
