"""Radiation models: what they reproduce of tables, that they are stable and passive, and which tables are refused."""

import numpy as np
import pytest
from scipy.integrate import simpson
from support.cummins import retardation

from dq_marine import Scene
from dq_marine.errors import InvalidInputError, VehicleFileError
from dq_marine.integrator.fluid_memory import LATERAL, VERTICAL
from dq_marine.physics.radiation.build import radiation_model
from dq_marine.physics.radiation.identification import identified
from dq_marine.physics.waves.radiation import RadiationTable
from dq_marine.vehicles import load_vehicle
from dq_marine.vehicles.validation import validated

VESSEL = load_vehicle("supply_vessel")
MODEL = radiation_model(VESSEL)
OMEGA = np.array(VESSEL.radiation.frequencies)


def symmetric(matrices):
    """The symmetric part."""
    matrices = np.array(matrices)
    return 0.5 * (matrices + matrices.transpose(0, 2, 1))


def table_of(omega, added, damping, infinite):
    """A table from arrays."""
    return RadiationTable(
        frequencies=tuple(omega.tolist()),
        added_mass=added.tolist(),
        damping=damping.tolist(),
        infinite=infinite.tolist(),
    )


def changed(**parts):
    """The vessel's content with another table of radiation."""
    table = VESSEL.radiation.model_dump() | parts
    return VESSEL.model_dump() | {"radiation": table}


def test_the_model_reproduces_the_table():
    """Damping to 5 %, added mass to 8 % over all motions; of each, between the ends, to 6 % of its largest and to 9 %.

    The row at 0.105 rad/s has added masses far below those of its neighbours, which no causal system with this damping
    has; and those of heave and pitch at 3.14 rad/s are larger than follows from the rest.
    """
    for quality in MODEL.quality.values():
        assert quality.damping < 0.05
        assert quality.added_mass < 0.08
    added, damping = symmetric(VESSEL.radiation.added_mass), symmetric(VESSEL.radiation.damping)
    for i in range(6):
        inner = slice(1, -1)
        misses = (MODEL.damping_at(OMEGA)[inner, i, i] - damping[inner, i, i]) / damping[:, i, i].max()
        assert np.abs(misses).max() < 0.06
        misses = np.abs(MODEL.added_mass_at(OMEGA)[inner, i, i] / added[inner, i, i] - 1.0)
        assert misses.max() < 0.09
    published = np.diag(VESSEL.added_mass_matrix)
    assert np.abs(np.diag(MODEL.added_mass) / published - 1.0).max() < 0.05


def test_the_model_is_stable_and_passive_at_all_frequencies():
    omega = np.geomspace(1e-4, 1e4, 801)
    damping = MODEL.damping_at(omega)
    scale = np.sqrt(np.einsum("nii->ni", damping).max(axis=0))
    least = np.linalg.eigvalsh(damping / np.outer(scale, scale)).min(axis=1)
    assert least.min() > -1e-12
    for section in MODEL.sections:
        assert np.linalg.eigvals(section.dynamics).real.max() < -1e-3
        assert np.linalg.eigvalsh(section.damping).min() > 0.0


def test_radiation_vanishes_with_the_frequency_and_far_beyond():
    """B ~ w^2 at 0 and ~ 1/w^2 at infinity, where A goes to A_inf."""
    low, high = MODEL.damping_at(np.array([1e-4, 2e-4])), MODEL.damping_at(np.array([1e3, 2e3]))
    for i in range(6):
        assert low[1, i, i] / low[0, i, i] == pytest.approx(4.0, rel=1e-3)
        assert high[0, i, i] / high[1, i, i] == pytest.approx(4.0, rel=1e-2)
    far = MODEL.added_mass_at(np.array([1e3]))[0]
    assert np.abs(far - MODEL.added_mass).max() < 1e-4 * np.abs(MODEL.added_mass).max()


def test_kramers_and_kronig_tie_damping_and_added_mass():
    """A(w) - A_inf = -(1/w) int_0^inf K(t) sin(w t) dt (Ogilvie), with K from B alone."""
    times = np.linspace(0.0, 120.0, 1201)
    kernel = retardation(MODEL.damping_at, times, 60.0, points=16001)
    omega = np.array([0.3, 0.6, 1.0, 1.6])
    for n, w in enumerate(omega):
        integral = simpson(kernel * np.sin(w * times)[:, None, None], x=times, axis=0)
        difference = MODEL.added_mass_at(omega)[n] - MODEL.added_mass
        for i in range(6):
            assert -integral[i, i] / w == pytest.approx(difference[i, i], abs=2e-3 * MODEL.added_mass[i, i])


def test_a_table_that_is_such_a_model_is_found_again():
    """Two planes with a section each, and an A_inf that is published 10 % too large."""
    omega = np.linspace(0.15, 4.0, 30)
    infinite = np.diag([1.0, 2.0, 3.0, 40.0, 50.0, 60.0]) * 1e5
    transfer = np.zeros((30, 6, 6), complex)
    for plane, w in ((VERTICAL, (0.6, 0.9, 1.4)), (LATERAL, (0.5, 1.1, 1.6))):
        gain = np.array([[300.0, 100.0, 400.0], [-50.0, 500.0, -900.0], [20.0, 60.0, 1500.0]])
        root = np.array([[0.8, 0.0, 0.0], [0.3, 0.9, 0.0], [-0.2, 0.4, 1.1]])
        for n, s in enumerate(1j * omega):
            stiff = s * s * np.eye(3) + s * (root @ root.T + 0.3 * np.eye(3)) + np.diag(np.square(w))
            transfer[n][np.ix_(plane.motions, plane.motions)] = s * gain.T @ np.linalg.inv(stiff) @ gain
    added = infinite + transfer.imag / omega[:, None, None]
    model = identified(table_of(omega, added, transfer.real, infinite * 1.1))
    for quality in model.quality.values():
        assert quality.damping < 0.02
        assert quality.added_mass < 0.01
    assert np.abs(np.diag(model.added_mass) / np.diag(infinite) - 1.0).max() < 0.02


def test_tables_that_cannot_be_used_are_refused():
    table = VESSEL.radiation
    few = {name: getattr(table, name)[:7] for name in ("frequencies", "added_mass", "damping")}
    negative = np.array(table.damping)
    negative[20] *= -1.0
    early = {name: getattr(table, name)[:24] for name in ("frequencies", "added_mass", "damping")}
    across = np.array(table.damping)
    across[:, 1, 2] = across[:, 2, 1] = 0.3 * across[:, 2, 2]
    jumbled = np.array(table.added_mass)[::-1]
    cases = {
        "7 frequencies; radiation memory needs at least 8": few,
        "negative at 0.6614 rad/s": {"damping": negative.tolist()},
        "has not fallen at its last frequency, 0.7854 rad/s": early,
        "couples surge, heave or pitch to sway": {"damping": across.tolist()},
        "cannot be fitted": {"added_mass": jumbled.tolist()},
    }
    for text, parts in cases.items():
        vehicle = validated(changed(**parts), "vehicle")
        with pytest.raises(InvalidInputError, match=text) as error:
            Scene(vehicle, radiation="memory")
        assert 'radiation="constant"' in str(error.value)
        Scene(vehicle)


def test_memory_needs_a_table_and_what_of_the_damping_it_replaces():
    with pytest.raises(InvalidInputError, match="no added mass and damping by frequency"):
        Scene("otter", radiation="memory")
    with pytest.raises(InvalidInputError, match="give one of"):
        Scene("supply_vessel", radiation="yes")
    content = VESSEL.model_dump()
    content["damping"]["wave_share"] = None
    with pytest.raises(InvalidInputError, match=r"would count twice; give damping\.wave_share"):
        Scene(validated(content, "vehicle"), radiation="memory")
    content["damping"]["wave_share"] = (0.0, 0.0, 1.2, 0.0, 0.0, 0.0)
    with pytest.raises(
        (InvalidInputError, VehicleFileError), match=r"wave_share\.2 = 1\.2: .*less than or equal to 1"
    ):
        validated(content, "vehicle")
