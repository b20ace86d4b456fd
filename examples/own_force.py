"""A force of your own: a tether that pulls once it is taut, in plain Python and compiled with the step."""

import math
from typing import NamedTuple

from dq_marine import ForceTerm, Scene, Spatial
from dq_marine.algebra.dual_quaternion import DualQuaternion, pose_position
from dq_marine.algebra.quaternion import rotate_inverse
from dq_marine.algebra.vector3 import Vector3, dot, scale, subtract


class Tether(NamedTuple):
    """Anchor in NED [m], length [m] and stiffness [N/m]."""

    anchor_ned: Vector3
    length: float
    stiffness: float


def tether(parameters: Tether, pose: DualQuaternion, time: float) -> Spatial:
    """Return the pull towards the anchor, at the body origin, in the body frame."""
    to_anchor = subtract(parameters.anchor_ned, pose_position(pose))
    distance = math.sqrt(dot(to_anchor, to_anchor))
    stretch = max(distance - parameters.length, 0.0)
    pull = scale(parameters.stiffness * stretch / max(distance, 1e-9), to_anchor)
    return Spatial((0.0, 0.0, 0.0), rotate_inverse(pose.real, pull))


def main() -> None:
    """Let a current carry a BlueROV2 to the end of its tether."""
    term = ForceTerm("tether", tether, Tether((0.0, 0.0, 5.0), 3.0, 50.0))
    scene = Scene(current=(0.4, 0.0, 0.0), forces=[term])
    print(scene)
    body = scene.stepper()
    body.reset(position_ned=(0.0, 0.0, 5.0))
    for _ in range(6):
        body.step(steps=500)
        distance = float(((body.position_ned - (0.0, 0.0, 5.0)) ** 2).sum() ** 0.5)
        print(f"{body.time:5.1f} s: {distance:.3f} m from the anchor")


if __name__ == "__main__":
    main()
