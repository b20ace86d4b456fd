"""What the file of a task needs from this package, in one place.

Import functions by name, not through this module: what is compiled finds them by the names they are called by.
"""

from __future__ import annotations

from dq_marine.algebra.elementary import arctangent, exponential, logarithm, sine_and_cosine
from dq_marine.algebra.euler import quaternion_from_euler
from dq_marine.algebra.level import seen_at
from dq_marine.algebra.quaternion import (
    Quaternion,
    quaternion_conjugate,
    quaternion_multiply,
    rotate,
    rotate_inverse,
)
from dq_marine.algebra.selection import select, spread
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
from dq_marine.checks import finite_array, finite_number, one_of
from dq_marine.envs.core.definition import EpisodeContext, ForVehicle, Goal, Observed, goal_along
from dq_marine.envs.core.module_task import define_task
from dq_marine.envs.core.observed import GOAL_MOTION, VELOCITY
from dq_marine.envs.core.places import goal_place
from dq_marine.envs.core.suitability import (
    cruising_speed,
    paced,
    speed_ahead,
    too_slow,
    unable_to_berth,
    unable_to_dive_under_way,
    unable_to_hold_a_pose,
    unable_to_keep_up,
    unable_to_position,
    unable_to_sail,
    unable_to_travel,
)
from dq_marine.integrator.body import Motion
from dq_marine.task.common import SPEED_BOUND, effort, make_pick, observed_curve_motion, observed_velocity
from dq_marine.task.harmonics import Curve, CurvePoint, curve_point, level_course, moved_to
from dq_marine.task.protocol import Situation, Start
from dq_marine.task.scenery import harmonics_seen
from dq_marine.task.shapes import SHAPE_DRAWS, SHAPES, STEEPEST, shaped_curve
from dq_marine.task.splines import beside, curvature, make_spline, make_winding, path_axes, winding_draws
from dq_marine.task.starts import SLOW_START_DRAWS, make_walk, slow_start, symmetric3

__all__ = [
    "GOAL_MOTION",
    "SHAPES",
    "SHAPE_DRAWS",
    "SLOW_START_DRAWS",
    "SPEED_BOUND",
    "STEEPEST",
    "VELOCITY",
    "ZERO",
    "Curve",
    "CurvePoint",
    "EpisodeContext",
    "ForVehicle",
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
    "arctangent",
    "beside",
    "bounded",
    "bounded_vector",
    "cruising_speed",
    "curvature",
    "curve_point",
    "define_task",
    "dot",
    "effort",
    "exponential",
    "finite_array",
    "finite_number",
    "goal_along",
    "goal_place",
    "harmonics_seen",
    "level_course",
    "logarithm",
    "make_pick",
    "make_spline",
    "make_walk",
    "make_winding",
    "moved_to",
    "norm",
    "observed_curve_motion",
    "observed_velocity",
    "one_of",
    "paced",
    "path_axes",
    "quaternion_conjugate",
    "quaternion_from_euler",
    "quaternion_multiply",
    "rotate",
    "rotate_inverse",
    "scale",
    "seen_at",
    "select",
    "shaped_curve",
    "sine_and_cosine",
    "slow_start",
    "speed_ahead",
    "spread",
    "subtract",
    "symmetric3",
    "too_slow",
    "unable_to_berth",
    "unable_to_dive_under_way",
    "unable_to_hold_a_pose",
    "unable_to_keep_up",
    "unable_to_position",
    "unable_to_sail",
    "unable_to_travel",
    "winding_draws",
]
