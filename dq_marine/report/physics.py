"""What a case is made of: one body's numbers, from which every method makes its stepper."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dq_marine.physics.current.build import uniform_water
from dq_marine.physics.damping.build import DampingTerm
from dq_marine.physics.hydrostatics.build import restoring_terms
from dq_marine.physics.term import ForceTerm
from dq_marine.simulation.assembly import Assembly

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Physics:
    """A body in water. Matrices and vectors of six in Fossen's order, SI.

    Attributes:
        mass_matrix: M, symmetric positive definite, shape (6, 6).
        excess_weight: W - B [N].
        arm: W r_G - B r_B [N m], shape (3,).
        linear: damping matrix, shape (6, 6).
        quadratic: damping coefficients, shape (6,).
        current_ned: velocity of the water [m/s], shape (3,).
        forces: others, such as a thrust that depends on time.
    """

    mass_matrix: Array
    excess_weight: float = 0.0
    arm: Array = field(default_factory=lambda: np.zeros(3))
    linear: Array = field(default_factory=lambda: np.zeros((6, 6)))
    quadratic: Array = field(default_factory=lambda: np.zeros(6))
    current_ned: Array = field(default_factory=lambda: np.zeros(3))
    forces: tuple[ForceTerm, ...] = ()

    def assembly(self, scheme: str = "midpoint", order: int = 2, kick: str = "l_stable") -> Assembly:
        """Return the physics as the integrator has it."""
        return Assembly(
            self.mass_matrix,
            (*restoring_terms(self.excess_weight, self.arm), *self.forces),
            DampingTerm(self.linear, self.quadratic, self.mass_matrix, kick == "l_stable"),
            uniform_water(self.current_ned),
            scheme,
            order,
        )

    def summary(self) -> dict[str, Any]:
        """Return the numbers as JSON has them, to tell one physics from another."""
        return {
            "mass_matrix": self.mass_matrix.tolist(),
            "excess_weight": self.excess_weight,
            "arm": self.arm.tolist(),
            "linear": self.linear.tolist(),
            "quadratic": self.quadratic.tolist(),
            "current_ned": self.current_ned.tolist(),
            "forces": [[force.name, force.parameters, force.kind] for force in self.forces],
        }
