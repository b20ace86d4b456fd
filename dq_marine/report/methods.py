"""The methods that are compared: this product's own and baselines, compiled in the same way from the same physics."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from typing import Literal, TypeAlias

import numpy as np

from dq_marine.integrator.step import Advance, Composition, StepParameters
from dq_marine.physics.damping.build import DampingTerm
from dq_marine.report.baselines.decoupled_lie import make_decoupled_lie
from dq_marine.report.baselines.dop853 import make_dop853
from dq_marine.report.baselines.dynamics import StepSize
from dq_marine.report.baselines.explicit_euler import make_explicit_euler
from dq_marine.report.baselines.rk4_euler import make_rk4_euler
from dq_marine.report.baselines.rk4_quaternion import make_rk4_quaternion
from dq_marine.report.baselines.rk4_transported import make_rk4_transported
from dq_marine.report.baselines.rkmk4 import make_rkmk4
from dq_marine.report.baselines.semi_implicit_euler import make_semi_implicit_euler
from dq_marine.report.physics import Physics
from dq_marine.simulation.assembly import Assembly
from dq_marine.simulation.one_body import OneBody

Family: TypeAlias = Literal["DQVI", "Gauss", "Explicit", "Runge-Kutta", "Euler", "Lie group"]


@dataclass(frozen=True)
class Method:
    """An integrator that advances one body.

    Attributes:
        name: in files and on the command line.
        title: in tables and plots.
        family: what it is akin to.
        order: of convergence.
        evaluations: of the forces, a step of a long call.
        damped_evaluations: the same where there is damping or a force that depends on the velocity.
        compose: (physics) -> its functions, and the numbers that go with them for a step size [s].
        refuse: (physics) -> why it cannot do that, or ''.
    """

    name: str
    title: str
    family: Family
    order: int
    evaluations: int
    damped_evaluations: int
    compose: Callable[[Physics], tuple[Composition, Callable[[float], StepParameters]]]
    refuse: Callable[[Physics], str]

    def refusal(self, physics: Physics) -> str:
        """Return why the method cannot do a physics, in a few words; '' if it can."""
        return self.refuse(physics)

    def body(self, physics: Physics, h: float) -> OneBody:
        """Return a body that is stepped by the method, at rest at the origin.

        Args:
            physics: what acts on it.
            h: step size [s].
        """
        composition, parameters_at = self.compose(physics)
        return OneBody(composition, parameters_at, h)


def compose_own(
    scheme: str, order: int, physics: Physics
) -> tuple[Composition, Callable[[float], StepParameters]]:
    """Return the product's own method."""
    assembly = physics.assembly(scheme=scheme, order=order)
    return assembly.composition, assembly.parameters_at


def compose_baseline(
    method: Callable[[Composition], Advance], physics: Physics
) -> tuple[Composition, Callable[[float], StepParameters]]:
    """Return a baseline: the product's own forces, inertia and water, and the damping as one force more."""
    assembly = explicit_assembly(physics)

    def parameters_at(h: float) -> StepParameters:
        return assembly.parameters_at(h)._replace(timing=StepSize(h))

    return replace(assembly.composition, method=method), parameters_at


def explicit_assembly(physics: Physics) -> Assembly:
    """Return the physics with its damping as a force that depends on the velocity."""
    damping = DampingTerm(physics.linear, physics.quadratic, physics.mass_matrix)
    undamped = replace(
        physics,
        forces=(*physics.forces, *damping.drag),
        linear=np.zeros((6, 6)),
        quadratic=np.zeros(6),
    )
    return undamped.assembly()


def nothing(physics: Physics) -> str:
    """Return '': no physics is refused."""
    return ""


def dissipation(physics: Physics) -> str:
    """Return why a composition of steps with negative stages cannot do a physics."""
    found = physics.assembly().dissipation
    return f"its negative stages cannot undo {found}" if found else ""


def any_damping(physics: Physics) -> str:
    """Return why order 6 is left out where something damps: orders 6 and 8 are one method there."""
    found = physics.assembly().dissipation
    return f"under {found} it is the method that `gauss8` stands for" if found else ""


FAMILIES: dict[str, Family] = {"gauss": "Gauss", "runge_kutta": "Explicit"}
"""Of schemes that are not variational."""


def own(
    name: str,
    title: str,
    order: int,
    evaluations: int,
    damped_evaluations: int,
    scheme: str = "midpoint",
    refuse: Callable[[Physics], str] = nothing,
) -> Method:
    """Return one of the product's own methods."""
    compose = partial(compose_own, scheme, order)
    return Method(
        name, title, FAMILIES.get(scheme, "DQVI"), order, evaluations, damped_evaluations, compose, refuse
    )


def baseline(
    name: str,
    title: str,
    family: Family,
    order: int,
    evaluations: int,
    method: Callable[[Composition], Advance],
    damped_evaluations: int | None = None,
) -> Method:
    """Return one of the baselines."""
    damped = evaluations if damped_evaluations is None else damped_evaluations
    compose = partial(compose_baseline, method)
    return Method(name, title, family, order, evaluations, damped, compose, nothing)


BY_SWEEPS = 41
"""Evaluations of the forces by a method with four stages that solves a step by sweeps: one, and about ten sweeps. It is
six sweeps where steps are short, 15 where they are long."""

BY_SWEEPS_OF_THREE = 31
"""The same by a method with three stages."""

METHODS = {
    method.name: method
    for method in (
        own("dqvi_paper", "DQVI, the paper's scheme", 2, 1, 1, scheme="paper"),
        own("dqvi2", "DQVI, order 2", 2, 1, 1),
        own("dqvi4", "DQVI, order 4", 4, 5, 5),
        own("dqvi6", "DQVI, order 6", 6, 9, 9, refuse=dissipation),
        own("dqvi8", "DQVI, order 8", 8, 17, 17, refuse=dissipation),
        own(
            "gauss6",
            "Gauss on the momentum, order 6",
            6,
            BY_SWEEPS_OF_THREE,
            BY_SWEEPS_OF_THREE,
            scheme="gauss",
            refuse=any_damping,
        ),
        own("gauss8", "Gauss on the momentum, order 8", 8, BY_SWEEPS, BY_SWEEPS, scheme="gauss"),
        own("galerkin8", "Galerkin DQVI, order 8", 8, BY_SWEEPS, BY_SWEEPS, scheme="galerkin"),
        own("rk4", "Runge-Kutta on the momentum, order 4", 4, 4, 4, scheme="runge_kutta"),
        own("rk8", "Runge-Kutta on the momentum, order 8", 8, 12, 12, scheme="runge_kutta"),
        baseline("rk4_quaternion", "RK4, quaternion", "Runge-Kutta", 4, 4, make_rk4_quaternion),
        baseline("rk4_transported", "RK4, momentum transported", "Runge-Kutta", 4, 4, make_rk4_transported),
        baseline("dop853", "DOP853, quaternion", "Runge-Kutta", 8, 12, make_dop853),
        baseline("rk4_euler", "RK4, Euler angles", "Runge-Kutta", 4, 4, make_rk4_euler),
        baseline("semi_implicit_euler", "Semi-implicit Euler", "Euler", 1, 1, make_semi_implicit_euler),
        baseline("explicit_euler", "Explicit Euler", "Euler", 1, 1, make_explicit_euler),
        baseline("rkmk4", "RKMK4 on SE(3)", "Lie group", 4, 4, make_rkmk4),
        baseline("decoupled_lie", "Lie group, SO(3) x R3", "Lie group", 2, 1, make_decoupled_lie, 2),
    )
}
"""The methods by name. With damping, DQVI of order 4 is extrapolation, with 2 + 3 kicks, instead of composition; and
`gauss8` is Radau's method of order 7 instead of Gauss's, for which `gauss6` would be but another name."""

SWEPT = tuple(
    name for name, method in METHODS.items() if method.evaluations in (BY_SWEEPS, BY_SWEEPS_OF_THREE)
)
"""Methods that solve a step by sweeps."""

WITH_STAGES = (*SWEPT, "rk4", "rk8")
"""The product's methods that leave steps which are too long for them to one of second order."""

UNSWEPT = {name: method for name, method in METHODS.items() if name not in SWEPT}
"""All other methods, by name: those of a quick report, for methods by sweeps take longest to compile."""
