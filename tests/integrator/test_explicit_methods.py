"""Explicit Runge-Kutta methods by themselves: their coefficients, and how they tell that a step is too long."""

import itertools

import numpy as np
import pytest
from scipy.integrate import DOP853
from support.bodies import make_body

from dq_marine.integrator import dormand_prince, verner
from dq_marine.integrator.classical_runge_kutta import CLASSICAL
from dq_marine.integrator.dormand_prince import DORMAND_PRINCE
from dq_marine.integrator.explicit import foresee_nothing
from dq_marine.integrator.runge_kutta import method_for
from dq_marine.integrator.verner import VERNER

STAGES = 12
WITH_A_WEIGHT = [0, *range(5, STAGES)]
"""Indices of the stages."""

METHODS = {"classical": CLASSICAL, "Dormand and Prince's": DORMAND_PRINCE, "Verner's": VERNER}

OF_ORDER_8 = {"Dormand and Prince's": dormand_prince.COEFFICIENTS, "Verner's": verner.COEFFICIENTS}

each_of_order_8 = pytest.mark.parametrize("own", OF_ORDER_8.values(), ids=OF_ORDER_8)


def matrix(own):
    """a_ij, with its zeros."""
    a = np.zeros((STAGES, STAGES))
    for i, row in enumerate(own.rows, start=1):
        columns = {1: [0], 2: [0, 1], 3: [0, 2], 4: [0, 2, 3]}.get(i, [0, *range(3, i)])
        a[i, columns] = row
    return a


def with_zeros(numbers):
    """Of the stages that have a weight, one for each stage."""
    whole = np.zeros(STAGES)
    whole[WITH_A_WEIGHT[: len(numbers)]] = numbers
    return whole


def test_coefficients_are_those_of_dop853():
    own = dormand_prince.COEFFICIENTS
    assert np.array_equal(matrix(own), DOP853.A[:STAGES, :STAGES])
    assert np.array_equal(own.nodes, DOP853.C[:STAGES])
    assert np.array_equal(with_zeros(own.weights), DOP853.B)
    assert np.array_equal(with_zeros(own.differences), DOP853.E5[:STAGES])


def trees(order):
    """All rooted trees with so many vertices, each as the sorted tuple of what grows from its root."""
    if order == 1:
        return {()}
    return {
        tuple(sorted(branches))
        for sizes in partitions(order - 1)
        for branches in itertools.product(*map(trees, sizes))
    }


def partitions(number, most=None):
    """All ways to write a number as a sum of numbers, the largest first."""
    most = number if most is None else most
    if number == 0:
        yield ()
    for first in range(min(number, most), 0, -1):
        for rest in partitions(number - first, first):
            yield (first, *rest)


def density(tree):
    """Vertices of a tree times the densities of its branches."""
    return vertices(tree) * np.prod([density(branch) for branch in tree])


def vertices(tree):
    return 1 + sum(map(vertices, tree))


def stage_values(a, tree):
    """What a tree stands for at the stages."""
    return np.prod([np.ones(len(a)), *(a @ stage_values(a, branch) for branch in tree)], axis=0)


@each_of_order_8
def test_coefficients_meet_all_conditions_of_order_8(own):
    """Butcher's, 200 of them: b . Phi(t) = 1/gamma(t) for every rooted tree t with up to eight vertices.

    Verner's coefficients are as large as 123, and weights as large as 32: so much larger is what rounding leaves.
    """
    a, b = matrix(own), with_zeros(own.weights)
    assert a.sum(axis=1) == pytest.approx(np.array(own.nodes), abs=1e-13)
    all_trees = [tree for order in range(1, 9) for tree in trees(order)]
    assert len(all_trees) == 200
    for tree in all_trees:
        assert b @ stage_values(a, tree) == pytest.approx(1.0 / density(tree), abs=1e-12), tree


@each_of_order_8
def test_differences_vanish_for_polynomials_and_tell_nothing_of_fine_steps(own):
    a, e = matrix(own), with_zeros(own.differences)
    for order in range(1, 6):
        for tree in trees(order):
            assert e @ stage_values(a, tree) == pytest.approx(0.0, abs=1e-13), tree


@pytest.mark.parametrize(
    ("method", "reach"), [(CLASSICAL, 2.6), (DORMAND_PRINCE, 5.0), (VERNER, 3.2)], ids=METHODS
)
@pytest.mark.parametrize("direction", [-1.0, 1.0j, np.exp(0.75j * np.pi), np.exp(0.65j * np.pi)])
def test_a_step_is_found_too_long_where_it_makes_deviations_grow(method, reach, direction):
    """Of y' = z y, with a deviation of any size: whatever would grow is found, and little else."""
    take_step = method.make_step(foresee_nothing, lambda z, node, y: z * y)
    is_stable = method.make_is_stable(lambda z, change: abs(change) ** 2)
    for length in np.geomspace(0.01, 1e6, 4000):
        z = complex(length * direction)
        for deviation in (1e-6, 1.0):
            taken = take_step(z, 1.0, deviation)
            growth = abs(taken.reached / deviation)
            stable = is_stable(z, taken.rates, 0.0)
            if growth > 1.0 + 1e-3:
                assert not stable, (z, growth)
            if length < reach:
                assert stable, (z, growth)


def test_a_scene_that_damps_has_the_method_whose_stability_reaches_further():
    free, damped = (
        make_body(np.eye(6), 0.1, scheme="runge_kutta", order=8, linear=rate * np.eye(6))._composition
        for rate in (0.0, 1.0)
    )
    assert method_for(free, 8) is VERNER
    assert method_for(damped, 8) is DORMAND_PRINCE
    assert method_for(free, 4) is method_for(damped, 4) is CLASSICAL
