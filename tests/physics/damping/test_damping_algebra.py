"""Damping with couplings and strips, as matrices: against tensors, differences and integrals written separately."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.integrate import quad
from support.bodies import make_damping, random_damping, random_inertia
from support.fossen import blended_drag, strip_drag

from dq_marine.algebra.spatial import matrix6_invert, matrix6_solve, to_fossen
from dq_marine.physics.damping.build import angular_first
from dq_marine.physics.damping.formulas.blended import Blend, blended_damping
from dq_marine.physics.damping.formulas.cross_flow import StripRow, make_strip_sums
from dq_marine.physics.damping.formulas.diagonal import DiagonalDamping
from dq_marine.physics.damping.formulas.matrix_entries import make_entry_addition
from dq_marine.physics.damping.formulas.matrix_kinds import ZERO, sparse_matrix
from dq_marine.physics.matrices import matrix6, spatial

seeds = st.integers(0, 2**32 - 1)
numbers = st.floats(-10.0, 10.0)


def array(m):
    """A `Matrix6` in Fossen's order."""
    a, b, c, d = (np.reshape(block, (3, 3)) for block in m)
    return angular_first(np.block([[a, b], [c, d]]))


def array_of(term, nu):
    """D(nu) of a term in Fossen's order, whatever kind of matrix it is."""
    d = term.algebra.at(term.matrices, spatial(nu))
    return array(term.algebra.add_scaled(ZERO, 1.0, d))


def random_term(rng, couplings=8):
    """Damping with some couplings, drawn from all that there can be, rows of strips in both planes, and blends.

    Its linear part is diagonal or full, as it comes.
    """
    tensor, signed = np.zeros((2, 6, 6, 6))
    for one in (tensor, signed):
        for entry in rng.integers(0, 6, (couplings, 3)):
            one[tuple(entry)] = rng.normal()
    strips = [
        ("sway", (rng.uniform(), *rng.normal(size=2), 5)),
        ("heave", (rng.uniform(), *rng.normal(size=2), 4)),
    ]
    blends = [(0, tuple(rng.uniform(0.2, 2.0, 3))), (5, tuple(rng.uniform(0.2, 2.0, 3)))]
    linear, quadratic = random_damping(rng), rng.uniform(size=6)
    if rng.integers(2):
        linear = np.diag(np.diag(linear))
    term = make_damping(random_inertia(rng), linear, quadratic, tensor, strips, blends=blends, signed=signed)

    def drag(nu):
        own = linear @ nu + quadratic * np.abs(nu) * nu + np.einsum("ijk,j,k->i", tensor, nu, np.abs(nu))
        own = own + np.einsum("ijk,j,k->i", signed, nu, nu)
        own = own + sum(strip_drag(plane, *row, nu) for plane, row in strips)
        return own + sum(blended_drag(axis, *numbers, nu) for axis, numbers in blends)

    return term, drag


@settings(max_examples=50)
@given(seed=seeds)
def test_the_drag_is_the_tensors_and_the_strips(seed):
    rng = np.random.default_rng(seed)
    term, drag = random_term(rng)
    nu = rng.normal(size=6)
    got = term.algebra.apply(term.algebra.at(term.matrices, spatial(nu)), spatial(nu))
    assert np.allclose(to_fossen(got), drag(nu), rtol=0, atol=1e-11)


@settings(max_examples=50)
@given(seed=seeds)
def test_the_slope_is_the_exact_derivative(seed):
    """Between kinks D(chi) chi is quadratic but for blends, and a central difference of any width is its derivative.

    So it may be wide, and the round-off of drags of 1e4 stays at 1e-9. What it leaves out of a blend, a sixth of the
    width squared times its third derivative, is below 1e-4 for the numbers drawn.
    """
    rng = np.random.default_rng(seed)
    term, drag = random_term(rng)
    nu = rng.normal(size=6)
    nu = np.sign(nu) * (0.1 + np.abs(nu))
    width = 1e-3
    steps = width * np.eye(6)
    differences = np.column_stack([(drag(nu + step) - drag(nu - step)) / (2.0 * width) for step in steps])
    slope = array(term.algebra.slope(term.matrices, spatial(nu)))
    assume(nearest_kink(term, nu) > width)
    blended = np.ix_([0, 5], [0])
    assert np.allclose(slope[blended], differences[blended], rtol=0, atol=1e-4)
    slope[blended] = differences[blended]
    assert np.allclose(slope, differences, rtol=0, atol=1e-7)


def nearest_kink(term, nu):
    """How slowly the slowest strip moves across the flow, over its lever."""
    moving = []
    for strips in term.strips:
        levers = strips.row.first + strips.row.spacing * np.arange(strips.number)
        across, rate = (nu[1], nu[5]) if strips.plane == (4, 2) else (nu[2], nu[4])
        moving.extend(np.abs(across + levers * rate) / (1.0 + np.abs(levers)))
    return min(moving)


@settings(max_examples=100)
@given(seed=seeds, nu=st.tuples(*[numbers] * 6))
def test_strips_only_take_energy(seed, nu):
    rng = np.random.default_rng(seed)
    rows = [
        ("sway", (rng.uniform(), *rng.normal(size=2), 7)),
        ("heave", (rng.uniform(), *rng.normal(size=2), 3)),
    ]
    term = make_damping(np.eye(6), np.zeros((6, 6)), np.zeros(6), strips=rows)
    matrix = array_of(term, np.array(nu))
    assert np.array_equal(matrix, matrix.T)
    assert np.linalg.eigvalsh(matrix).min() >= -1e-12 * max(1.0, np.abs(matrix).max())


@pytest.mark.parametrize(("speed", "rate"), [(0.7, 0.0), (0.0, -0.4), (0.3, 0.9), (-0.5, 0.1)])
def test_many_strips_are_the_integral_over_the_hull(speed, rate):
    """Of c |v + x r| x^n over a hull from -0.4 m to 1.2 m, with its kink told to SciPy's quadrature."""
    kink = [-speed / rate] if rate else None
    exact = [
        quad(lambda x, n=n: 3.0 * abs(speed + x * rate) * x**n, -0.4, 1.2, points=kink)[0] for n in range(3)
    ]
    errors = []
    for count in (40, 400):
        width = 1.6 / count
        row = StripRow(3.0 * width, -0.4 + 0.5 * width, width)
        errors.append(np.abs(np.subtract(make_strip_sums(count)(row, speed, rate), exact)).max())
    assert errors[0] < 5e-3
    assert errors[1] < max(errors[0] / 50.0, 1e-12)


@settings(max_examples=50)
@given(seed=seeds)
def test_unsymmetric_systems_are_solved(seed):
    """M + h D with a D of couplings alone, as lift makes it, small enough for the linear block to be regular."""
    rng = np.random.default_rng(seed)
    term, _ = random_term(rng)
    m, nu, load = random_inertia(rng), rng.normal(size=6), rng.normal(size=6)
    d = array_of(term, nu)
    system = matrix6(angular_first(m + 0.05 * d))
    exact = np.linalg.solve(m + 0.05 * d, load)
    assert np.allclose(to_fossen(matrix6_solve(system, spatial(load))), exact, rtol=1e-9, atol=1e-9)
    assert np.allclose(array(matrix6_invert(system)), np.linalg.inv(m + 0.05 * d), rtol=1e-9, atol=1e-9)


@settings(max_examples=50)
@given(seed=seeds, couplings=st.integers(0, 12))
def test_a_sparse_matrix_is_its_array(seed, couplings):
    """Its sum with a matrix, its product with a vector and its products on both sides of a matrix."""
    rng = np.random.default_rng(seed)
    places = sorted({(i, j) for i, j in rng.integers(0, 6, (couplings, 2)).tolist() if i != j})
    kind = sparse_matrix(tuple(places))
    diagonal, numbers, m, chi = rng.normal(size=6), rng.normal(size=12), *split(rng)
    d = kind.own_at(DiagonalDamping(spatial(diagonal), spatial(np.zeros(6))), spatial(chi))
    d_array = np.diag(angular_first(np.diag(diagonal)).diagonal().copy())
    for (row, column), number in zip(places, numbers, strict=False):
        d = make_entry_addition(kind.place(row, column))(d, number)
        d_array[row, column] += number
    for row in range(6):
        d = make_entry_addition(kind.place(row, row))(d, 0.5)
        d_array[row, row] += 0.5
    d_array, wide = angular_first(d_array), matrix6(angular_first(m))
    assert np.allclose(array(kind.add_scaled(wide, 0.3, d)), m + 0.3 * d_array, rtol=0, atol=1e-13)
    assert np.allclose(to_fossen(kind.apply(d, spatial(chi))), d_array @ chi, rtol=0, atol=1e-13)
    assert np.allclose(array(kind.sandwich(d, wide)), d_array @ m @ d_array, rtol=0, atol=1e-11)
    assert np.allclose(to_fossen(kind.diagonal(d)), d_array.diagonal(), rtol=0, atol=1e-13)


def split(rng):
    """A symmetric matrix and a velocity."""
    m = rng.normal(size=(6, 6))
    return m + m.T, rng.normal(size=6)


def test_equal_structures_share_their_functions():
    """Whatever the numbers; another coupling, plane or number of strips makes another one."""
    rng = np.random.default_rng(3)
    tensor = np.zeros((6, 6, 6))
    tensor[1, 1, 0] = 2.0
    row = (1.0, 0.0, 0.1, 5)

    def kick(couplings, strips, blends=()):
        term = make_damping(
            np.eye(6), random_damping(rng), rng.uniform(size=6), couplings, strips, blends=blends
        )
        return term.kick

    one = kick(tensor, [("sway", row)])
    assert kick(3.0 * tensor, [("sway", (2.0, 0.3, 0.2, 5))]) is one
    others = [
        kick(tensor, ()),
        kick(None, [("sway", row)]),
        kick(tensor, [("heave", row)]),
        kick(tensor, [("sway", (*row[:3], 6))]),
        kick(tensor.transpose(0, 2, 1), [("sway", row)]),
        kick(tensor, [("sway", row)], [(0, (1.0, 2.0, 3.0))]),
        kick(tensor, [("sway", row)], [(5, (1.0, 2.0, 3.0))]),
    ]
    assert len({one, *others}) == 8


@given(u=numbers, v=numbers, d=st.floats(0.0, 10.0), q=st.floats(0.0, 10.0), c=st.floats(0.01, 10.0))
def test_blends_only_take_energy_and_lie_between_their_parts(u, v, d, q, c):
    damping = blended_damping(Blend(d, q, c), u, v)
    low, high = sorted((d, q * abs(v)))
    assert low * (1.0 - 1e-12) <= damping <= high * (1.0 + 1e-12)
