"""Bodies built straight from matrices, without a vehicle's plausibility."""

from __future__ import annotations

import numpy as np

from dq_marine.algebra.spatial import from_fossen
from dq_marine.backend.packing import pack, unpack
from dq_marine.integrator.step import ACCEPTED, make_advance
from dq_marine.physics.contact.build import NOTHING_SOLID
from dq_marine.physics.current.build import uniform_water
from dq_marine.physics.damping.build import BlendTerm, DampingTerm, StripTerm
from dq_marine.physics.damping.formulas.blended import Blend
from dq_marine.physics.damping.formulas.coupled import HEAVE_PLANE, SWAY_PLANE
from dq_marine.physics.damping.formulas.cross_flow import StripRow
from dq_marine.physics.hydrostatics.build import restoring_terms
from dq_marine.physics.term import WaterTerm
from dq_marine.simulation.assembly import Assembly
from dq_marine.simulation.one_body import OneBody


class PlainBody(OneBody):
    """A body whose step runs in plain Python: for a few hundred steps that takes less than compiling them."""

    def _compiled_advance(self):
        advance = make_advance(self._composition)

        def advance_arrays(parameters, state, wrench, time, steps):
            force = from_fossen(tuple(wrench.tolist()))
            outcome = advance(
                unpack(self.parameters, parameters),
                unpack(self._composition.at_rest, state),
                force,
                time,
                steps,
            )
            if outcome.status == ACCEPTED:
                state[:] = pack(outcome.state)
            return (
                outcome.status,
                outcome.completed,
                outcome.iterations,
                outcome.fallbacks,
                outcome.residual_squared,
            )

        return advance_arrays


def random_inertia(rng, condition=20.0, coupled=True):
    """A random symmetric positive definite 6x6 M (Fossen's order) with the given condition number."""
    if not coupled:
        return np.diag(np.exp(rng.uniform(0.0, np.log(condition), 6)))
    basis, _ = np.linalg.qr(rng.normal(size=(6, 6)))
    eigenvalues = np.exp(np.linspace(0.0, np.log(condition), 6))
    m = basis @ np.diag(eigenvalues) @ basis.T
    return 0.5 * (m + m.T)


def jacobian_round_off(condition):
    """By which a drift's Jacobian may differ from its complex-step derivative, relative to its largest entry.

    Both have products with M22^-1 M21, which enlarge rounding errors by up to the condition number of M. The largest
    difference of 10,500 draws was 2.4 eps for a condition of 1, and 0.8 eps times a condition of 1e6.
    """
    return 16.0 * np.finfo(float).eps * condition


def random_damping(rng, scale=1.0):
    """A random dissipative 6x6 matrix, not symmetric."""
    a = rng.normal(size=(6, 6))
    skew = rng.normal(size=(6, 6))
    return scale * (a @ a.T / 6.0 + 0.5 * np.eye(6) + 0.3 * (skew - skew.T))


def random_quaternion(rng):
    q = rng.normal(size=4)
    return q / np.linalg.norm(q)


def make_damping(
    mass_matrix, linear, quadratic, couplings=None, strips=(), l_stable=True, blends=(), signed=None
):
    """A `DampingTerm`; see `make_body`."""
    terms = []
    for plane, (coefficient, first, spacing, number) in strips:
        side = 1.0 if plane == "sway" else -1.0
        row = StripRow(coefficient, side * first, side * spacing)
        terms.append(StripTerm(SWAY_PLANE if plane == "sway" else HEAVE_PLANE, row, number))
    tensors = [np.zeros((6, 6, 6)) if c is None else np.asarray(c, dtype=float) for c in (couplings, signed)]
    blended = tuple(BlendTerm(axis, Blend(*numbers)) for axis, numbers in blends)
    return DampingTerm(
        linear, quadratic, mass_matrix, l_stable, tensors[0], tuple(terms), blended, tensors[1]
    )


def make_body(
    mass_matrix,
    step,
    *,
    excess_weight=0.0,
    arm=(0.0, 0.0, 0.0),
    linear=None,
    quadratic=None,
    couplings=None,
    strips=(),
    blends=(),
    signed=None,
    current=(0.0, 0.0, 0.0),
    scheme="midpoint",
    order=2,
    l_stable=True,
    forces=(),
    contact=NOTHING_SOLID,
    kind=OneBody,
):
    """A `OneBody` with any M, restoring, damping (Fossen's order), current and forces; or a `PlainBody`.

    Couplings are the tensor c_ijk, signed that of the signed ones, strips pairs (plane "sway" or "heave", (c, first x,
    spacing, number)), blends pairs (axis, (linear, quadratic, crossover)).
    """
    mass_matrix = np.asarray(mass_matrix, dtype=float)
    linear = np.zeros((6, 6)) if linear is None else np.asarray(linear, dtype=float)
    quadratic = np.zeros(6) if quadratic is None else np.asarray(quadratic, dtype=float)
    assembly = Assembly(
        mass_matrix,
        (*restoring_terms(excess_weight, np.asarray(arm, dtype=float)), *forces),
        make_damping(mass_matrix, linear, quadratic, couplings, strips, l_stable, blends, signed),
        current if isinstance(current, WaterTerm) else uniform_water(np.asarray(current, dtype=float)),
        scheme,
        order,
        contact=contact,
    )
    return kind(assembly.composition, assembly.parameters_at, step)
