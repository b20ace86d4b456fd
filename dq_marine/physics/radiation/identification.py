"""Identifies a hull's radiation model from its table, by least squares in the frequency domain.

What is fitted is B(w) + j w A(w), each motion scaled by its largest damping. A_inf is among the unknowns: a table
ends somewhere, and the value published for infinity need not follow from what the table has (the relations of Kramers
and Kronig tie A to B at all frequencies). Oscillators keep to frequencies near the table's, and none is so strongly or
so weakly damped that the table could not tell. A row that does not go with its neighbours counts less (soft L1).
"""

from __future__ import annotations

import functools
from typing import Any, NamedTuple

import numpy as np

from dq_marine.errors import InvalidInputError
from dq_marine.integrator.fluid_memory import LATERAL, VERTICAL, Plane
from dq_marine.physics.radiation.checks import checked_plane
from dq_marine.physics.radiation.least_squares import robust_least_squares, soft_l1
from dq_marine.physics.radiation.model import PLANE_NAMES, Array, Quality, RadiationModel, SectionModel
from dq_marine.physics.waves.radiation import RadiationTable

GOOD = 0.05
"""Relative error of H with which no further section is tried."""

ACCEPTABLE = 0.15
"""The largest that is accepted."""

MOST_SECTIONS = 2
"""Of a plane."""

LEAST_DAMPING = 0.1
"""Of each oscillator by itself, relative."""

MOST_DAMPING = 2.0
"""Size of an entry of the factor of D, relative to the root of the frequency."""

OUTLYING = (10.0, 0.05)
"""Residual, over the largest damping, from which an entry counts less: at first none does."""

STARTS = 3
"""Of the search."""

SETTLED = 1e-4
"""Relative change of the sum of squares at which the fit ends."""

EVALUATIONS = 200
"""Of the residuals, at most."""


class PlaneTable(NamedTuple):
    """The part of a table in one plane, scaled.

    Attributes:
        plane: which.
        omega: frequencies, shape (n,).
        values: B + j w A over scale_i scale_j, shape (n, 3, 3).
        infinite: published A_inf, likewise, shape (3, 3).
        scale: root of each motion's largest damping; 1 for a motion without, shape (3,).
    """

    plane: Plane
    omega: Array
    values: Any
    infinite: Array
    scale: Array


@functools.lru_cache(maxsize=32)
def identified(table: RadiationTable) -> RadiationModel:
    """Return the radiation model of a hull; once made it is kept.

    Raises:
        InvalidInputError: the table cannot be used, or no model fits it.
    """
    infinite = np.array(table.infinite)
    infinite = 0.5 * (infinite + infinite.T)
    added, sections = infinite.copy(), []
    quality: dict[Plane, Quality] = {}
    for plane in (VERTICAL, LATERAL):
        omega, b, a = checked_plane(table, plane)
        if not b.any():
            continue
        largest = np.sqrt(np.abs(np.diagonal(b, axis1=1, axis2=2)).max(axis=0))
        scale = np.where(largest > 0.0, largest, 1.0)
        cut = np.ix_(plane.motions, plane.motions)
        scales = np.outer(scale, scale)
        scaled = PlaneTable(
            plane, omega, (b + 1j * omega[:, None, None] * a) / scales, infinite[cut] / scales, scale
        )
        fit = fitted_plane(scaled)
        quality[plane] = fit.quality
        sections += fit.sections
        added[cut] = fit.infinite * scales
    return RadiationModel(tuple(sections), added, infinite, quality)


class PlaneFit(NamedTuple):
    """A plane's sections, its scaled A_inf, how good they are, and the relative error of H."""

    sections: list[SectionModel]
    infinite: Array
    quality: Quality
    error: float


def fitted_plane(table: PlaneTable) -> PlaneFit:
    """Return the fit with the fewest sections that is good, or else the best.

    Raises:
        InvalidInputError: it is not acceptable.
    """
    best: PlaneFit | None = None
    for count in range(1, MOST_SECTIONS + 1):
        fit = PlaneProblem(table, count).solve()
        best = fit if best is None or fit.error < best.error else best
        if best.error <= GOOD:
            break
    assert best is not None  # noqa: S101 - told to the type checker
    if best.error > ACCEPTABLE:
        raise InvalidInputError(
            f"the radiation table in {PLANE_NAMES[table.plane]} cannot be fitted: the error is {best.error:.0%} of it, "
            f"more than {ACCEPTABLE:.0%}; its added mass and damping may not belong together. Mend it, or give "
            'radiation="constant"'
        )
    return best


class PlaneProblem:
    """The least squares problem of one plane with a number of sections.

    Unknowns: of W, where in its band; the lower triangle of L of every section, with D = W^(1/2) (2 z + L L^T) W^(1/2);
    G; A_inf. W and L are bounded by functions of unknowns that are not: see `squeezed`.
    """

    def __init__(self, table: PlaneTable, count: int) -> None:
        self.table, self.oscillators = table, 3 * count
        rows, columns = np.tril_indices(self.oscillators)
        together = rows // 3 == columns // 3
        self.lower = (rows[together], columns[together])
        self.upper = np.triu_indices(3)
        self.weights = np.where(self.upper[0] == self.upper[1], 1.0, np.sqrt(2.0))
        self.s = 1j * table.omega[:, None, None]
        n = self.oscillators
        self.ends = np.cumsum([n, self.lower[0].size, 3 * n, 6])

    def solve(self) -> PlaneFit:
        """Return the best fit of some starts."""
        found = [self.search(self.start(variant)) for variant in range(STARTS)]
        losses = [soft_l1(self.residuals(unknowns), OUTLYING[-1]) for unknowns in found]
        return self.fit_of(found[int(np.argmin(losses))])

    def search(self, start: Array) -> Array:
        """Return the unknowns of a least loss near a start."""
        found = start
        for outlying in OUTLYING:
            found = robust_least_squares(
                self.residuals,
                self.slopes,
                found,
                outlying=outlying,
                settled=SETTLED,
                evaluations=EVALUATIONS,
            )
        return found

    def start(self, variant: int) -> Array:
        """Return frequencies spread over where damping is, much damping, and gains that differ between variants."""
        n, omega = self.oscillators, self.table.omega
        power = np.abs(np.trace(self.table.values.real, axis1=1, axis2=2))
        share = np.cumsum(power * np.gradient(omega))
        quantiles = np.interp((np.arange(n) + 0.5) / n, share / share[-1], omega)
        order = np.arange(n).reshape(3, -1).T.ravel()  # each section has low, middle and high ones
        low, high = np.log(self.band)
        places = loosened((np.log(quantiles[order]) - low) / (high - low) * 2.0 - 1.0)
        factor = np.where(self.lower[0] == self.lower[1], loosened(np.array(1.0 / MOST_DAMPING)), 0.0)
        gain = 0.5 * np.cos((2.0 + variant) * np.outer(np.arange(n) + 1.0, np.arange(3) + 1.0))
        return np.concatenate([places, factor, gain.ravel(), self.table.infinite[self.upper]])

    @property
    def band(self) -> tuple[float, float]:
        """Least and largest frequency of an oscillator."""
        return float(self.table.omega[0]), 1.5 * float(self.table.omega[-1])

    def parts(self, unknowns: Array) -> tuple[Array, Array, Array, Array]:
        """Return W, L, G and A_inf."""
        n = self.oscillators
        places, entries, gains, upper = np.split(unknowns, self.ends[:-1])
        low, high = np.log(self.band)
        factor, infinite = np.zeros((n, n)), np.zeros((3, 3))
        factor[self.lower], infinite[self.upper] = MOST_DAMPING * squeezed(entries), upper
        infinite = infinite + infinite.T - np.diag(np.diag(infinite))
        w = np.exp(low + 0.5 * (high - low) * (1.0 + squeezed(places)))
        return w, factor, gains.reshape(n, 3), infinite

    def damping(self, w: Array, factor: Array) -> Array:
        """Return D."""
        root = np.sqrt(w)
        relative = 2.0 * LEAST_DAMPING * np.eye(w.size) + factor @ factor.T
        return np.asarray(root[:, None] * relative * root)

    def answer(self, w: Array, factor: Array, gain: Array) -> Any:
        """Return (s^2 + s D + W^2)^-1 G, shape (n, oscillators, 3)."""
        stiff = self.s * self.s * np.eye(w.size) + self.s * self.damping(w, factor) + np.diag(w**2)
        return np.linalg.solve(stiff, np.broadcast_to(gain + 0.0j, (self.s.shape[0], *gain.shape)))

    def residuals(self, unknowns: Array) -> Array:
        """Return real and imaginary parts of the model less the table, entries off the diagonal counting twice."""
        w, factor, gain, infinite = self.parts(unknowns)
        model = self.s * (gain.T @ self.answer(w, factor, gain) + infinite)
        return self.flat(model - self.table.values)

    def slopes(self, unknowns: Array) -> Array:
        """Return the derivative of the residuals by the unknowns."""
        w, factor, gain, _ = self.parts(unknowns)
        n, s = self.oscillators, self.s
        places, entries, *_ = np.split(unknowns, self.ends[:-1])
        by_place = 0.5 * np.log(self.band[1] / self.band[0]) * squeezed_slope(places)
        by_entry = MOST_DAMPING * squeezed_slope(entries)
        x = self.answer(w, factor, gain)
        damped = self.damping(w, factor) @ x
        weighted = (factor.T * np.sqrt(w)) @ x
        columns = []
        for k in range(n):
            half = symmetric_product(x[:, k], 0.5 * s[:, :, 0] * damped[:, k] + w[k] ** 2 * x[:, k])
            columns.append(-by_place[k] * s * half)
        for i, j, slope in zip(*self.lower, by_entry, strict=True):
            columns.append(-slope * s * s * np.sqrt(w[i]) * symmetric_product(x[:, i], weighted[:, j]))
        units = np.eye(3)
        for k in range(n):
            columns += [
                s * symmetric_product(x[:, k], np.broadcast_to(unit, x[:, k].shape)) for unit in units
            ]
        for i, j in zip(*self.upper, strict=True):
            entry = np.zeros((3, 3))
            entry[i, j] = entry[j, i] = 1.0
            columns.append(s * entry)
        return np.stack([self.flat(column) for column in columns], axis=1)

    def flat(self, matrices: Any) -> Array:
        """Return the upper triangles' real and imaginary parts, weighted, in one array."""
        entries = matrices[:, self.upper[0], self.upper[1]] * self.weights
        return np.concatenate([entries.real.ravel(), entries.imag.ravel()])

    def fit_of(self, unknowns: Array) -> PlaneFit:
        """Return the sections, and how well they fit."""
        w, factor, gain, infinite = self.parts(unknowns)
        damping = self.damping(w, factor)
        sections = [
            SectionModel(self.table.plane, w[part], damping[part, part], gain[part] * self.table.scale)
            for part in (slice(first, first + 3) for first in range(0, self.oscillators, 3))
        ]
        wanted = self.table.values - self.s * infinite
        missed = self.s * (gain.T @ self.answer(w, factor, gain)) - wanted
        quality = Quality(relative(missed.real, wanted.real), relative(missed.imag, self.table.values.imag))
        return PlaneFit(sections, infinite, quality, relative(missed, wanted))


def squeezed(unknown: Array) -> Array:
    """Return a number from -1 to 1 for any."""
    return np.asarray(np.sin(np.arctan(unknown)))


def squeezed_slope(unknown: Array) -> Array:
    """Return its derivative."""
    return np.asarray(np.cos(np.arctan(unknown)) ** 3)


def loosened(squeezed: Array) -> Array:
    """Return the number that is squeezed to one between -1 and 1."""
    return np.asarray(np.tan(np.arcsin(squeezed)))


def symmetric_product(a: Any, b: Any) -> Any:
    """Return a b^T + b a^T of vectors, shape (n, 3, 3)."""
    product = a[:, :, None] * b[:, None, :]
    return product + product.transpose(0, 2, 1)


def relative(missed: Any, wanted: Any) -> float:
    """Return the root mean square of what is missed over that of what is wanted."""
    return float(np.linalg.norm(missed) / np.linalg.norm(wanted))
