"""Scenes of one vehicle with nothing, with one term, and with all: what each term costs, and only then."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from dq_marine.algebra.dual_quaternion import DualQuaternion, pose_position
from dq_marine.algebra.quaternion import rotate_inverse
from dq_marine.algebra.spatial import Spatial
from dq_marine.algebra.vector3 import scale
from dq_marine.physics.term import ForceTerm
from dq_marine.simulation.scene import Scene
from dq_marine.vehicles import Vehicle, load_vehicle

VEHICLE = "bluerov2_heavy"
CURRENT = (0.3, 0.0, 0.0)
STEP = 0.02
NOTHING, EVERYTHING = "inertia alone", "everything"


def spring(stiffness: float, pose: DualQuaternion, time: float) -> Spatial:
    """Return the wrench of a spring [N/m] to the world's origin: a force as a user may write one."""
    pull = scale(-stiffness, pose_position(pose))
    return Spatial((0.0, 0.0, 0.0), rotate_inverse(pose.real, pull))


def scenes(order: int = 2) -> dict[str, Scene]:
    """Return scenes with no term, with each alone, and with all, by what they have."""
    terms = terms_alone(forces=[ForceTerm("spring", spring, 5.0)])
    return {name: Scene(**given, step=STEP, order=order) for name, given in terms.items()}


def terms_alone(forces: Sequence[ForceTerm] = ()) -> dict[str, dict[str, Any]]:
    """Return arguments of scenes with no term, with each alone, and with all, by what they have.

    Args:
        forces: of the user, one term more if there are any.
    """
    own = load_vehicle(VEHICLE)
    bare = neutral(own)
    linear = changed(bare, "damping", linear=own.damping.linear)
    mooring = {"forces": list(forces)} if forces else {}
    return {
        NOTHING: {"vehicle": bare},
        "net weight": {"vehicle": changed(bare, "buoyancy", volume=own.buoyancy.volume)},
        "righting moment": {"vehicle": changed(bare, "buoyancy", center=own.buoyancy.center)},
        "current": {"vehicle": bare, "current": CURRENT},
        **({"a force of your own": {"vehicle": bare, **mooring}} if forces else {}),
        "linear damping": {"vehicle": linear},
        "linear and quadratic damping": {
            "vehicle": changed(linear, "damping", quadratic=own.damping.quadratic)
        },
        EVERYTHING: {"vehicle": own, "current": CURRENT, **mooring},
    }


def neutral(vehicle: Vehicle) -> Vehicle:
    """Return the vehicle with neither net weight, righting moment nor damping."""
    volume = vehicle.rigid_body.mass / vehicle.buoyancy.water_density
    content = vehicle.model_dump()
    content["buoyancy"] |= {"volume": volume, "center": vehicle.rigid_body.center_of_mass}
    content["damping"] = {"linear": [0.0] * 6, "quadratic": [0.0] * 6}
    return Vehicle.model_validate(content)


def changed(vehicle: Vehicle, table: str, **entries: object) -> Vehicle:
    """Return the vehicle with some entries of one of its tables replaced."""
    content = vehicle.model_dump()
    content[table] |= entries
    return Vehicle.model_validate(content)
