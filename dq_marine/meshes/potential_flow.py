"""Added mass and wave radiation damping of a hull, by the linear potential flow solver Capytaine.

Ancellin, M. and Dias, F. (2019). Capytaine: a Python-based linear potential flow solver. Journal of Open Source
Software 4(36), 1341. Constant panels, and the direct boundary integral equation: the indirect one, its default, errs
more for the same panels.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from dq_marine.errors import InvalidInputError
from dq_marine.meshes.surface import Array
from dq_marine.util.extras import extra_needed

Progress = Callable[[str, int, int], None]
"""Called with what is being solved, how many problems are done, and how many there are."""


def untold(solving: str, done: int, problems: int) -> None:
    """Tell nobody."""


TO_UP = np.array([1.0, -1.0, -1.0])
"""From forward-starboard-down to Capytaine's axes, x forward, y to port, z up; and back."""

MIRRORED = np.array([[-1.0, 1.0, 1.0, 1.0, -1.0, -1.0], [1.0, -1.0, 1.0, -1.0, 1.0, -1.0]])
"""Signs that the six motions take in a mirror across x = 0, and across y = 0."""

NEGLIGIBLE = 1e-5
"""Couplings below this part of sqrt(A_ii A_jj) are round-off of the panels, and are written as 0."""


@dataclass(frozen=True, eq=False)
class PotentialFlow:
    """What a hull's panels and the water make of its motions.

    Attributes:
        panels: of the wet surface, axes forward-starboard-down, shape (n, 3, 3) [m]; of a hull afloat, z = 0 is the
            still waterline.
        reference: the point that motions and moments refer to, shape (3,) [m].
        density: of the water [kg/m^3].
        gravity: [m/s^2].
        floats: whether there is a free surface; else the water is unbounded.
        progress: told how far it is.
        mirrors: whether the hull is its own mirror image across x = 0 and y = 0; of what cannot be coupled then, the
            panels give small numbers, which are left out.
    """

    panels: Array
    reference: Array
    density: float
    gravity: float
    floats: bool
    progress: Progress
    mirrors: tuple[bool, bool] = (False, False)

    def added_mass(self) -> Array:
        """Return M_A, symmetric, shape (6, 6): at infinite frequency, or in unbounded water [kg, kg m, kg m^2].

        Raises:
            MissingDependencyError: Capytaine is not installed.
            InvalidInputError: the solver gives no added mass that a body could have.
        """
        added, _ = self._solved([math.inf if self.floats else 1.0], "added mass", lid=False)
        if not np.isfinite(added).all() or np.linalg.eigvalsh(added[0]).min() < -1e-3 * np.trace(added[0]):
            raise InvalidInputError(
                "the solver gives an added mass that is not positive: the hull has parts thinner than its panels, or "
                "crosses itself; mend the mesh, or give more --panels"
            )
        return np.asarray(added[0])

    def by_frequency(self, frequencies: Sequence[float]) -> tuple[Array, Array]:
        """Return added mass and radiation damping, symmetric, each of shape (n, 6, 6).

        A lid on the water within the hull keeps irregular frequencies away.

        Args:
            frequencies: rising [rad/s].

        Raises:
            MissingDependencyError: Capytaine is not installed.
            InvalidInputError: the solver gives numbers that are not finite.
        """
        added, damping = self._solved(frequencies, "radiation", lid=True)
        if not (np.isfinite(added).all() and np.isfinite(damping).all()):
            raise InvalidInputError(
                "the solver gives numbers that are not finite; mend the mesh, or give other --panels"
            )
        return added, damping

    def _solved(self, frequencies: Sequence[float], what: str, *, lid: bool) -> tuple[Array, Array]:
        with extra_needed("vehicles from a mesh", "bem"):
            import capytaine
        capytaine.set_logging("ERROR")
        body = self._body(capytaine, lid)
        # The table of the wave part takes half a minute to make, once on a machine; without waves it is not needed.
        size = {} if lid else {"tabulation_nr": 0, "tabulation_nz": 0}
        solver = capytaine.BEMSolver(method="direct", green_function=capytaine.Delhommeau(**size))
        names = list(body.dofs)
        found = np.zeros((2, len(frequencies), 6, 6))
        for i, omega in enumerate(frequencies):
            for j, name in enumerate(names):
                self.progress(what, 6 * i + j, 6 * len(frequencies))
                problem = capytaine.RadiationProblem(
                    body=body,
                    radiating_dof=name,
                    omega=omega,
                    rho=self.density,
                    g=self.gravity,
                    water_depth=math.inf,
                    free_surface=0.0 if self.floats else math.inf,
                )
                result = solver.solve(problem, keep_details=False, _check_wavelength=False)
                found[0, i, :, j] = [result.added_masses[force] for force in names]
                found[1, i, :, j] = [result.radiation_dampings[force] for force in names]
        self.progress(what, 6 * len(frequencies), 6 * len(frequencies))
        added, damping = (_symmetric(part, self.mirrors) for part in found)
        return added, damping

    def _body(self, capytaine: Any, lid: bool) -> Any:
        corners = (self.panels * TO_UP).reshape(-1, 3)
        faces = np.arange(len(corners)).reshape(-1, 3)
        mesh = capytaine.Mesh(corners, faces, auto_check=False)
        motions = capytaine.rigid_body_dofs(rotation_center=tuple(self.reference * TO_UP))
        cover = mesh.generate_lid() if lid else None
        return capytaine.FloatingBody(mesh=mesh, dofs=motions, lid_mesh=cover)


def _symmetric(matrices: Array, mirrors: tuple[bool, bool]) -> Array:
    """Return symmetric parts in axes forward-starboard-down, in which couplings that are round-off are 0."""
    signs = np.concatenate([TO_UP, TO_UP])
    turned = matrices * np.outer(signs, signs)
    symmetric = 0.5 * (turned + turned.transpose(0, 2, 1))
    for parity, mirrored in zip(MIRRORED, mirrors, strict=True):
        if mirrored:
            symmetric = np.where(np.outer(parity, parity) > 0.0, symmetric, 0.0)
    diagonals = np.sqrt(np.abs(np.einsum("nii->ni", symmetric)))
    scale = diagonals[:, :, None] * diagonals[:, None, :]
    return np.asarray(np.where(np.abs(symmetric) < NEGLIGIBLE * scale, 0.0, symmetric))
