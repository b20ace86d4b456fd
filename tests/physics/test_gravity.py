"""A scene's gravity: all that is weighed or floats follows it, and so do the lengths of waves."""

import math
import pickle

import numpy as np
import pytest
from support.fossen import errors, solve

from dq_marine.algebra.dual_quaternion import pose_from_parts
from dq_marine.algebra.spatial import Spatial, to_fossen
from dq_marine.backend.packing import pack
from dq_marine.errors import InvalidInputError
from dq_marine.physics.hydrostatics.build import hydrostatic_terms
from dq_marine.physics.waves.dispersion import wave_numbers
from dq_marine.physics.weather import Jonswap, PiersonMoskowitz, Sea, SlowDrift, weather_of, weather_terms
from dq_marine.randomisation import Randomisation
from dq_marine.simulation.scene import Scene
from dq_marine.vehicles import load_vehicle, vehicle_names
from dq_marine.vehicles.validation import validated

MARS, MOON = 3.72, 1.62
STILL = np.zeros(3)


@pytest.mark.parametrize("name", vehicle_names())
def test_what_is_weighed_and_what_floats_goes_with_it(name):
    vehicle = load_vehicle(name)
    there = vehicle.in_gravity(MARS)
    assert vehicle.gravity == 9.81
    assert there.gravity == MARS
    assert there.weight == vehicle.rigid_body.mass * MARS
    for number in (
        "buoyant_force",
        "specific_weight",
        "payload_weight",
        "payload_moment",
        "restoring_arm",
        "waterplane_stiffness",
    ):
        here = getattr(vehicle, number)
        if here is not None:
            expected = MARS / 9.81 * np.asarray(here)
            np.testing.assert_allclose(
                getattr(there, number), expected, rtol=1e-13, atol=1e-12 * vehicle.weight
            )
    kept = {"gravity", "hydrostatics"}
    assert there.model_dump(exclude=kept) == vehicle.model_dump(exclude=kept)


@pytest.mark.parametrize("name", vehicle_names())
def test_natural_frequencies_go_with_its_root(name):
    """Those of a pendulum, of roll and pitch by the metacentre, and of heave."""
    hulls = ["linear", "hull"] if load_vehicle(name).hull else ["linear"]
    for hydrostatics in hulls:
        here = Scene(name, hydrostatics=hydrostatics, step=0.01).restoring_frequencies
        there = Scene(name, hydrostatics=hydrostatics, step=0.01, gravity=MOON).restoring_frequencies
        np.testing.assert_allclose(there, here * math.sqrt(MOON / 9.81), rtol=1e-9)


def test_the_default_is_the_vehicles_own_bit_for_bit():
    vehicle = load_vehicle("otter")
    assert vehicle.in_gravity(9.81) is vehicle
    sea = Sea(Jonswap(0.3, 4.0), 0.7, components=4)
    assert sea.in_gravity(9.81) is sea
    scenes = [Scene("otter", weather=[sea], **given) for given in ({}, {"gravity": None}, {"gravity": 9.81})]
    numbers = [pack(scene.parameters_at(0.02)) for scene in scenes]
    assert np.array_equal(numbers[0], numbers[1])
    assert np.array_equal(numbers[0], numbers[2])
    other = pack(Scene("otter", weather=[sea], gravity=9.80665).parameters_at(0.02))
    assert not np.array_equal(numbers[0], other)


def test_a_file_says_its_own_and_a_scene_another():
    content = load_vehicle("otter").model_dump() | {"gravity": 9.80665}
    vehicle = validated(content, "a test")
    assert vehicle.weight == vehicle.rigid_body.mass * 9.80665
    assert Scene(vehicle).gravity == 9.80665
    scene = Scene(vehicle, gravity=MARS)
    assert scene.gravity == scene.vehicle.gravity == MARS
    assert vehicle.gravity == 9.80665
    again = pickle.loads(pickle.dumps(scene))
    assert again.gravity == MARS
    assert "gravity=3.72" in repr(again)


@pytest.mark.parametrize("wrong", [0.0, -9.81, 0.05, 31.0, math.nan, math.inf, "much"])
def test_what_is_no_gravity_is_refused(wrong):
    with pytest.raises(InvalidInputError, match="gravity"):
        Scene(gravity=wrong)
    with pytest.raises(InvalidInputError, match="gravity"):
        validated(load_vehicle("remus100").model_dump() | {"gravity": wrong}, "a test")
    with pytest.raises(InvalidInputError, match="gravity"):
        Jonswap(1.0, 8.0, gravity=wrong)


def test_drawn_vehicles_keep_it():
    vehicle = load_vehicle("bluerov2_heavy").in_gravity(MOON)
    drawn = Randomisation.load("default").pool(vehicle, 3)
    assert [one.gravity for one in drawn] == [MOON] * 3
    here = Randomisation.load("default").pool(load_vehicle("bluerov2_heavy"), 3)
    for there, one in zip(drawn, here, strict=True):
        np.testing.assert_allclose(
            there.restoring_arm / MOON, one.restoring_arm / 9.81, atol=1e-12 * one.weight
        )


def test_waves_are_as_long_as_it_says():
    omega = np.array([0.3, 1.0, 2.5])
    assert wave_numbers(omega, gravity=MARS).tolist() == (omega**2 / MARS).tolist()
    k = wave_numbers(omega, 5.0, MARS)
    np.testing.assert_allclose(MARS * k * np.tanh(5.0 * k), omega**2, rtol=1e-12)
    sea = Sea(Jonswap(0.3, 6.0), 0.4, seed=3, spreading=2.0)
    there = sea.in_gravity(MARS)
    assert there.gravity == MARS
    for name in ("amplitudes", "frequencies", "directions", "phases"):
        assert np.array_equal(getattr(there, name), getattr(sea, name))
    np.testing.assert_allclose(there.wave_numbers, sea.frequencies**2 / MARS, rtol=1e-15)
    assert there.elevation(3.0) == sea.elevation(3.0)
    assert there.elevation(3.0, 10.0) != sea.elevation(3.0, 10.0)


def test_a_grown_sea_is_the_published_one_under_it():
    """S = 0.0081 g^2 omega^-5 exp(-0.74 (g/(U omega))^4)."""
    omega, wind = np.array([0.4, 0.6, 1.1]), 8.0
    published = 0.0081 * MARS**2 * omega**-5 * np.exp(-0.74 * (MARS / (wind * omega)) ** 4)
    np.testing.assert_allclose(PiersonMoskowitz(wind, gravity=MARS).density(omega), published, rtol=2e-3)


def test_a_sea_that_would_break_under_it_is_refused():
    weather = [Sea(Jonswap(1.0, 3.0))]
    Scene("remus100", weather=weather)
    with pytest.raises(InvalidInputError, match="steepness"):
        Scene("remus100", weather=weather, gravity=MOON)


def with_linear_damping(name, factor):
    """A catalogue vehicle with so many times its linear damping."""
    content = load_vehicle(name).model_dump()
    linear = factor * np.array(content["damping"]["linear"])
    content["damping"] = content["damping"] | {"linear": linear.tolist()}
    content.pop("radiation")  # a table by frequency does not scale
    return validated(content, name)


@pytest.mark.parametrize("depth", [None, 8.0])
@pytest.mark.parametrize("name", ["otter", "supply_vessel", "remus100"])
def test_forces_obey_froudes_similarity(name, depth):
    """Under a quarter of the gravity all goes half as fast, along the same paths, by a quarter of the forces.

    Linear damping, which knows no such law, is halved.
    """
    floats = load_vehicle(name).hydrostatics is not None
    length = load_vehicle(name).dimensions.length
    depth = depth if depth is None else depth * length
    period = 1.5 * math.sqrt(length)

    def wrenches(slowness):
        sea = Sea(
            Jonswap(0.01 * length, slowness * period), 0.7, seed=2, spreading=3.0, depth=depth, components=6
        )
        scene = Scene(
            with_linear_damping(name, 1.0 / slowness),
            gravity=9.81 / slowness**2,
            weather=[sea, SlowDrift(sea)] if floats else [sea],
        )
        terms = [
            *hydrostatic_terms(scene.vehicle, "linear"),
            *weather_terms(weather_of(scene.weather), scene.vehicle, STILL),
        ]
        assert len(terms) >= 2
        attitude = np.array([1.0, 0.05, -0.03, 0.6]) / np.linalg.norm([1.0, 0.05, -0.03, 0.6])
        pose = pose_from_parts(tuple(attitude.tolist()), (3.0, -2.0, 0.2 if floats else 4.0))
        rates = [
            (0.1 / slowness, -0.2 / slowness, 0.05 / slowness),
            (1.0 / slowness, 0.3 / slowness, 0.1 / slowness),
        ]
        for time in (0.0, 1.3, 7.9):
            moment = (Spatial(*rates), slowness * time)
            for term in terms:
                given = moment if term.uses_velocity else moment[1:]
                yield to_fossen(term.function(term.parameters, pose, *given))

    here, there = (np.array(list(wrenches(slowness))) for slowness in (1.0, 2.0))
    assert (np.abs(here).max(axis=1) > 0.0).all()
    np.testing.assert_allclose(there, 0.25 * here, rtol=1e-9, atol=1e-11 * np.abs(here).max())


def test_a_vehicle_under_it_moves_as_the_separately_written_equations_say():
    vehicle = load_vehicle("bluerov2_heavy")
    mass, water = vehicle.rigid_body.mass * MOON, 1000.0 * vehicle.buoyancy.volume * MOON
    arm = mass * np.array(vehicle.rigid_body.center_of_mass) - water * np.array(vehicle.buoyancy.center)
    start = (0.0, 0.0, 5.0), (math.cos(0.6), math.sin(0.6), 0.0, 0.0), (0.3, 0.0, 0.1, 0.0, 0.2, 0.0)
    damping = {
        "linear": vehicle.linear_damping,
        "quadratic": vehicle.quadratic_damping,
        "couplings": vehicle.damping_couplings,
        "signed": vehicle.signed_damping_couplings,
    }
    reference = solve(vehicle.mass_matrix, *start, 4.0, excess_weight=mass - water, arm=arm, **damping)
    body = Scene("bluerov2_heavy", gravity=MOON, step=0.005).stepper()
    body.reset(*start)
    body.step(steps=800)
    assert max(errors(body, reference)) < 1e-4
    earth = Scene("bluerov2_heavy", step=0.005).stepper()
    earth.reset(*start)
    earth.step(steps=800)
    assert min(errors(earth, reference)) > 1e-2
