"""A vessel that floats, in a vehicle file: its waterplane, its hull as boxes, and its payloads."""

from __future__ import annotations

from typing import Annotated, Literal, Self, TypeAlias

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator

from dq_marine.physics.fields import Matrix3, Positive, Table, Vector3
from dq_marine.physics.implausible import Implausible

Count: TypeAlias = Annotated[int, Field(ge=1, le=1000)]

FORM_NUMBERS = ("waterplane_area", "metacentric_height_transverse", "metacentric_height_longitudinal")
"""Numbers that replace `stiffness`, together with `center_of_flotation`."""


class Hydrostatics(Table):
    """Hydrostatics of a vessel that floats, for small motions about its rest.

    Either `stiffness`, or the waterplane's area, centre of flotation and the two metacentric heights.

    Attributes:
        equilibrium_depth: z of the body origin at rest [m]; 0 where it lies in the still waterline.
        waterplane_area: A_w [m^2].
        center_of_flotation: x of the waterplane's centroid [m].
        metacentric_height_transverse: GM_T [m].
        metacentric_height_longitudinal: GM_L [m].
        stiffness: of heave, roll and pitch about the body origin, 3 x 3 [N/m, N, N m], under the vehicle's `gravity`.
        force_axes: "earth": along the vertical, with a potential; or "body": along the axes of the
            vessel, for models published so: heave on a trimmed vessel then also pushes it along.
    """

    equilibrium_depth: float = 0.0
    waterplane_area: Positive | None = None
    center_of_flotation: float | None = None
    metacentric_height_transverse: float | None = None
    metacentric_height_longitudinal: float | None = None
    stiffness: Matrix3 | None = None
    force_axes: Literal["earth", "body"] = "earth"

    @model_validator(mode="after")
    def _one_of_two(self) -> Self:
        given = [name for name in (*FORM_NUMBERS, "center_of_flotation") if getattr(self, name) is not None]
        if self.stiffness is not None and given:
            raise Implausible(
                "hydrostatics.stiffness",
                "a matrix",
                f"{', '.join(given)} say it too",
                "give the stiffness, or the waterplane's area and the metacentric heights",
            )
        missing = [name for name in FORM_NUMBERS if name not in given]
        if self.stiffness is None and missing:
            raise Implausible(
                "hydrostatics",
                f"without {', '.join(missing)}",
                "the stiffness does not follow",
                f"give {', '.join(FORM_NUMBERS)}, or stiffness",
            )
        return self

    def times(self, factor: float) -> Hydrostatics:
        """Return the same under a gravity that is so many times larger: a stiffness in N/m grows with it."""
        if self.stiffness is None:
            return self
        rows = (factor * np.array(self.stiffness)).tolist()
        return Hydrostatics.model_validate(dict(self) | {"stiffness": rows})

    def stiffness_about_origin(self, specific_weight: float, buoyant_force: float) -> NDArray[np.float64]:
        """Return C of heave, roll and pitch about the body origin, shape (3, 3) [N/m, N, N m].

        That of the centre of flotation, diag(rho g A_w, B GM_T, B GM_L), is moved as H^T C H (Fossen 2021, sec. 4.2).

        Args:
            specific_weight: rho g [N/m^3].
            buoyant_force: B = rho g V [N].
        """
        if self.stiffness is not None:
            return np.array(self.stiffness)
        area, transverse, longitudinal = (getattr(self, name) for name in FORM_NUMBERS)
        at_flotation = np.diag(
            [specific_weight * area, buoyant_force * transverse, buoyant_force * longitudinal]
        )
        # The centre of flotation sinks by z - x_f theta.
        moved = np.eye(3)
        moved[0, 2] = -(self.center_of_flotation or 0.0)
        return np.asarray(moved.T @ at_flotation @ moved)


class HullBox(Table):
    """A box that displaces water; its walls are vertical when the vessel is upright.

    Attributes:
        position: centre [m].
        size: length, width and height [m].
        cells: columns along x and y that it is cut into; chosen from the size if left out.
    """

    position: Vector3
    size: tuple[Positive, Positive, Positive]
    cells: tuple[Count, Count] | None = None


class Payload(Table):
    """A weight that acts besides those at rest with the buoyancy, on a vessel that floats or not.

    Attributes:
        mass: whose weight it is [kg]; it adds nothing to the mass matrix, where `rigid_body` has all masses.
        position: [m].
    """

    mass: Positive
    position: Vector3
