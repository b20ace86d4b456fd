"""A complete vehicle from a mesh: every table of a vehicle file, and the reason for every number in it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from dq_marine.meshes.choices import Choices
from dq_marine.meshes.drag import Drag, Form, estimated_drag, linear_damping
from dq_marine.meshes.estimates import righting_stiffness, rigid_body, shape_of, speed_of, wrench_limits
from dq_marine.meshes.hull import Hull, read_hull
from dq_marine.meshes.limits import validity
from dq_marine.meshes.panels import panels_of
from dq_marine.meshes.potential_flow import PotentialFlow, Progress
from dq_marine.meshes.radiation import Radiated, radiated
from dq_marine.meshes.rounding import rounded
from dq_marine.meshes.surface import Array, mirror_planes
from dq_marine.physics.matrices import skew
from dq_marine.vehicles.model import Vehicle
from dq_marine.vehicles.validation import validated

CAPYTAINE = (
    "Ancellin, M. and Dias, F. (2019). Capytaine: a Python-based linear potential flow solver. Journal of Open Source "
    "Software 4(36), 1341: added mass."
)


@dataclass(frozen=True, eq=False)
class BuiltVehicle:
    """A vehicle made from a mesh.

    Attributes:
        vehicle: valid as a whole.
        content: what its file says, but for radiation.
        reasons: where the numbers of a table or key come from.
        hull: that it was made from.
        panels: that were solved for.
        waves: coefficients by frequency; None if they were not asked for.
    """

    vehicle: Vehicle
    content: Mapping[str, Any]
    reasons: Mapping[str, Sequence[str]]
    hull: Hull
    panels: int
    waves: Radiated | None


def build_vehicle(mesh: Path, choices: Choices, progress: Progress) -> BuiltVehicle:
    """Return the vehicle that a mesh and choices make.

    Args:
        mesh: an STL file.
        choices: what else is known.
        progress: told how far the solver is.

    Raises:
        InvalidInputError: the mesh or a choice is unfit.
        MissingDependencyError: Capytaine is not installed.
    """
    hull = read_hull(mesh, choices)
    body, why_body = rigid_body(hull, choices)
    stiffness = righting_stiffness(hull, np.array(body["center_of_mass"]), choices, mesh)
    panels = panels_of(hull.wet, choices.panels, str(mesh))
    level = np.array([0.0, 0.0, hull.waterline or 0.0])
    flow = PotentialFlow(
        panels - level,
        -level,
        choices.density,
        choices.gravity,
        choices.floats,
        progress,
        mirror_planes(hull.surface),
    )
    added = np.array(rounded(flow.added_mass()))
    inertia = rigid_body_matrix(body)
    waves = radiated(flow, choices.frequencies, inertia, stiffness) if choices.frequencies else None
    form = Form(hull.wet, shape_of(hull, choices), choices.floats, choices.density, speed_of(hull, choices))
    drag = estimated_drag(form)
    natural = None if waves is None else waves.at_natural_frequencies
    righting = np.concatenate([np.zeros(2), np.diag(stiffness), np.zeros(1)])
    linear, why_linear = linear_damping(form, drag, inertia + added, righting, natural)
    ahead = (linear[0] + drag.quadratic[0] * form.speed) * form.speed
    damping = {"linear": rounded(linear), "quadratic": rounded(drag.quadratic)}
    if natural is not None:
        damping["wave_share"] = rounded(wave_share(np.array(linear), natural))
    limits, why_limits = wrench_limits(hull, choices, ahead, form.speed)
    content = _content(mesh, hull, choices, form, drag) | {
        "rigid_body": body,
        "added_mass": added.tolist(),
        "damping": damping,
        "limits": {"wrench": rounded(limits)},
        "validity": validity(hull, choices, form),
    }
    if hull.waterline is not None:
        content["hydrostatics"] = {
            "equilibrium_depth": rounded(-hull.waterline),
            "stiffness": rounded(stiffness),
        }
    reasons = _reasons(choices, drag, len(panels)) | {
        "rigid_body": why_body,
        "damping": (*drag.own_axes, *why_linear),
        "limits": (why_limits,),
    }
    whole = content if waves is None else content | {"radiation": waves.table}
    return BuiltVehicle(validated(whole, str(mesh)), content, reasons, hull, len(panels), waves)


def wave_share(linear: Array, radiated: Array) -> Array:
    """Return how much of each linear damping is radiation, 0 where there is none; all of shape (6,)."""
    part = np.clip(radiated, 0.0, linear)
    return np.asarray(np.divide(part, linear, out=np.zeros(6), where=linear > 0.0))


def rigid_body_matrix(body: Mapping[str, Any]) -> Array:
    """Return M_RB about the body origin of a table `rigid_body` about the centre of mass (Fossen 2021, ch. 3)."""
    mass, s = body["mass"], skew(np.array(body["center_of_mass"]))
    inertia = np.array(body["inertia"]) - mass * s @ s
    return np.array(np.block([[mass * np.eye(3), -mass * s], [mass * s, inertia]]))


def _content(mesh: Path, hull: Hull, choices: Choices, form: Form, drag: Drag) -> dict[str, Any]:
    """Return what a vehicle's file says that follows from the hull and its drag alone."""
    size = rounded(hull.surface.extent)
    kind = "afloat" if choices.floats else "under water"
    dimensions = dict(zip(("length", "width", "height"), size, strict=True))
    keel = float(hull.surface.vertices[:, 2].max())
    if choices.floats and keel > 0.0:
        dimensions["draft"] = rounded(keel)
    content: dict[str, Any] = {
        "name": choices.name or mesh.stem.replace("_", " "),
        "description": f"Hull of {size[0]:.4g} m {kind}, from a mesh: added mass by a panel method, damping estimated",
        "sources": [f"{mesh.name}: shape of the hull and its hydrostatics.", CAPYTAINE, *drag.sources],
        "cross_flow": [rounded(table) for table in drag.cross_flow],
        "buoyancy": {
            "volume": rounded(hull.volume),
            "center": rounded(hull.center_of_buoyancy),
            "water_density": choices.density,
        },
        "dimensions": dimensions | {"shape": form.shape},
        "appearance": {
            "file": str(mesh.resolve()),
            "unit": choices.unit,
            "axes": choices.axes,
            "origin": rounded(-hull.origin),
        },
    }
    return content | (
        {"gravity": choices.gravity} if choices.gravity != Vehicle.model_fields["gravity"].default else {}
    )


def _reasons(choices: Choices, drag: Drag, panels: int) -> dict[str, Sequence[str]]:
    """Return where numbers come from that are not estimated elsewhere."""
    water = "at infinite frequency, under a free surface" if choices.floats else "in unbounded water"
    return {
        "added_mass": (f"Capytaine, direct method, {panels} panels, {water}; symmetric part",),
        "radiation": (
            "by frequency, of the same panels, in deep water; a lid within the hull keeps irregular frequencies away",
        ),
        "cross_flow": drag.strips,
        "buoyancy": ("integrals over the mesh's triangles, without approximation",),
        "hydrostatics": (
            "of heave, roll and pitch about the body origin: integrals over the mesh's triangles, and the weight",
        ),
        "appearance": ("the mesh itself, which is drawn where the extra `models` is installed",),
        "dimensions": (
            f"the box around the mesh; shape {'given' if choices.shape else 'guessed from its proportions'}",
        ),
    }
