"""What the file of a task needs from this package, in one place.

Import functions by name, not through this module: what is compiled finds them by the names they are called by.
"""

from __future__ import annotations

from dq_marine.algebra.quaternion import (
    Quaternion,
    quaternion_conjugate,
    quaternion_multiply,
    rotate,
    rotate_inverse,
)
from dq_marine.algebra.selection import select
from dq_marine.algebra.spatial import ZERO, Spatial
from dq_marine.algebra.vector3 import (
    Vector3,
    add,
    add_scaled,
    bounded,
    bounded_vector,
    dot,
    norm,
    scale,
    subtract,
)
from dq_marine.checks import finite_array, finite_number
from dq_marine.envs.core.definition import EpisodeContext, Goal, Observed
from dq_marine.envs.core.module_task import define_task
from dq_marine.envs.core.observed import VELOCITY
from dq_marine.envs.core.places import goal_place
from dq_marine.envs.core.suitability import unable_to_hold_a_pose, unable_to_travel
from dq_marine.integrator.body import Motion
from dq_marine.task.common import effort, make_pick, observed_velocity
from dq_marine.task.protocol import Situation, Start
from dq_marine.task.starts import SLOW_START_DRAWS, make_walk, slow_start, symmetric3

__all__ = [
    "SLOW_START_DRAWS",
    "VELOCITY",
    "ZERO",
    "EpisodeContext",
    "Goal",
    "Motion",
    "Observed",
    "Quaternion",
    "Situation",
    "Spatial",
    "Start",
    "Vector3",
    "add",
    "add_scaled",
    "bounded",
    "bounded_vector",
    "define_task",
    "dot",
    "effort",
    "finite_array",
    "finite_number",
    "goal_place",
    "make_pick",
    "make_walk",
    "norm",
    "observed_velocity",
    "quaternion_conjugate",
    "quaternion_multiply",
    "rotate",
    "rotate_inverse",
    "scale",
    "select",
    "slow_start",
    "subtract",
    "symmetric3",
    "unable_to_hold_a_pose",
    "unable_to_travel",
]
