"""What of a hull is under water, and the hydrostatics that follow from it: exact for its triangles.

Axes forward-starboard-down, the still waterline at z = 0. All is integrated over the wet triangles alone: the
waterplane closes them, and adds nothing to integrals of z n_z (z = 0) or of n_x (n_x = 0), while int f(x, y) n_z dS
over the wet hull is the integral of f over the waterplane.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from dq_marine.errors import InvalidInputError
from dq_marine.meshes.surface import Array, Surface, area_vectors, enclosed

BISECTIONS = 60


def wet_part(corners: Array) -> Array:
    """Return the parts of triangles below z = 0 (z > 0), cut at the waterline, as triangles, shape (n, 3, 3)."""
    wet = corners[..., 2] > 0.0
    count = wet.sum(axis=1)
    pieces = [corners[count == 3]]
    for here, alone in ((count == 1, wet), (count == 2, ~wet)):
        chosen = corners[here]
        lead = alone[here].argmax(axis=1)
        rows = np.arange(len(chosen))
        a, b, c = (chosen[rows, (lead + k) % 3] for k in range(3))
        ab, ac = _crossing(a, b), _crossing(a, c)
        if alone is wet:
            pieces.append(np.stack([a, ab, ac], axis=1))
        else:
            pieces += [np.stack([ab, b, c], axis=1), np.stack([ab, c, ac], axis=1)]
    return np.concatenate(pieces)


def _crossing(a: Array, b: Array) -> Array:
    """Return where segments meet z = 0, shape (n, 3)."""
    share = a[:, 2] / (a[:, 2] - b[:, 2])
    points = a + share[:, None] * (b - a)
    points[:, 2] = 0.0
    return np.asarray(points)


@dataclass(frozen=True)
class Flotation:
    """A hull afloat, upright.

    Attributes:
        volume: displaced [m^3].
        center: of buoyancy [m], shape (3,).
        area: of the waterplane [m^2].
        first_moments: integrals of x and y over the waterplane [m^3], shape (2,).
        second_moments: integrals of (x, y)(x, y)^T over the waterplane [m^4], shape (2, 2).
    """

    volume: float
    center: Array
    area: float
    first_moments: Array
    second_moments: Array

    def stiffness(self, weight: float, center_of_mass: Array, specific_weight: float) -> Array:
        """Return C of heave, roll and pitch about the origin, shape (3, 3) [N/m, N, N m].

        Newman (1977), Marine Hydrodynamics, ch. 6, in axes forward-starboard-down.

        Args:
            weight: m g [N].
            center_of_mass: [m], shape (3,).
            specific_weight: rho g [N/m^3].
        """
        (sx, sy), ((sxx, sxy), (_, syy)) = self.first_moments, self.second_moments
        plane = np.array([[self.area, sy, -sx], [sy, syy, -sxy], [-sx, -sxy, sxx]])
        righting = weight * center_of_mass[2] - specific_weight * self.volume * self.center[2]
        return np.asarray(specific_weight * plane + np.diag([0.0, righting, righting]))


def flotation(wet: Array) -> Flotation:
    """Return the hydrostatics of wet triangles, as `wet_part` gives them."""
    middle = wet.mean(axis=1)
    sums = wet.sum(axis=1)
    # int p p^T over a triangle is A/12 (s s^T + a a^T + b b^T + c c^T), int p is A s/3.
    products = (np.einsum("mi,mj->mij", sums, sums) + np.einsum("mki,mkj->mij", wet, wet)) / 12.0
    down = area_vectors(wet)[:, 2]
    volume = float(middle[:, 2] @ down)
    center = (
        np.array([products[:, 0, 2] @ down, products[:, 1, 2] @ down, 0.5 * products[:, 2, 2] @ down])
        / volume
        if volume > 0.0
        else np.zeros(3)
    )
    area = float(down.sum())
    first = middle[:, :2].T @ down
    second = np.einsum("mij,m->ij", products[:, :2, :2], down)
    return Flotation(volume, center, area, first, second)


def draft_of_mass(hull: Surface, volume: float, name: str) -> float:
    """Return the draft at which a hull displaces a volume, upright [m].

    Args:
        hull: in axes forward-starboard-down.
        volume: [m^3].
        name: of the mesh, for messages.

    Raises:
        InvalidInputError: the hull displaces less with all of it under water.
    """
    whole = enclosed(hull.corners).volume
    if not volume < whole:
        raise InvalidInputError(
            f"{name} cannot float: it encloses {whole:.6g} m^3, and is to displace {volume:.6g} m^3; give a "
            "smaller mass, check --unit, or leave out --afloat for a vehicle under water"
        )
    keel = float(hull.vertices[:, 2].max())
    low, high = 0.0, float(hull.extent[2])
    for _ in range(BISECTIONS):
        draft = 0.5 * (low + high)
        displaced = flotation(wet_part(hull.corners - [0.0, 0.0, keel - draft])).volume
        low, high = (draft, high) if displaced < volume else (low, draft)
    return 0.5 * (low + high)
