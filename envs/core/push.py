"""A push on the vehicle of an episode under way, at a point of its body: a person's hand, or a test of robustness."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from dq_marine.algebra.quaternion import rotate_inverse
from dq_marine.algebra.spatial import spatial_add_scaled, wrench_at
from dq_marine.backend.packing import pack
from dq_marine.checks import finite_array, length_of
from dq_marine.errors import InvalidInputError
from dq_marine.integrator.body import BODY_NUMBERS

if TYPE_CHECKING:
    from dq_marine.envs.core.marine_env import MarineEnv

LARGEST_FORCE = 1e9
"""Of a push [N]: hundreds of times what moves the largest ship."""

FARTHEST_POINT = 1e3
"""From the body origin, that can be pushed [m]."""

PUSHED = "pushed by hand"


def push(env: MarineEnv, point_body: Sequence[float], force_ned: Sequence[float]) -> None:
    """Push the vehicle for the control period that comes next; its replay says that it was pushed.

    The force acts at the period's beginning, as the impulse that it gives over the whole period, at the point where it
    is then: F h on the momentum, and r x F h on the angular one. That is a kick of the integrator, once in a period
    instead of once in a step, so that the step needs no term for it.

    Args:
        env: in an episode.
        point_body: that is pushed, from the body origin in body axes [m], shape (3,).
        force_ned: in the world's axes [N], shape (3,).

    Raises:
        InvalidInputError: a number is not finite or too large; nothing is changed.
        ResetNeeded: before the first reset.
    """
    point = _within("point_body", point_body, FARTHEST_POINT, "m")
    force = _within("force_ned", force_ned, LARGEST_FORCE, "N")
    episode = env.episode
    body = episode.body
    force_body = rotate_inverse(body.pose.real, tuple(force.tolist()))
    wrench = wrench_at(tuple(point.tolist()), force_body)
    kicked = spatial_add_scaled(body.momentum, env.control_period, wrench)
    episode.state[: BODY_NUMBERS - 1] = pack(body._replace(momentum=kicked))
    env.annotate(PUSHED)


def _within(name: str, values: Sequence[float], most: float, unit: str) -> NDArray[np.float64]:
    checked = finite_array(name, values, 3)
    if not length_of(checked) <= most:
        raise InvalidInputError(
            f"{name} = {checked.tolist()} {unit} is too large; give at most {most:g} {unit}"
        )
    return checked
