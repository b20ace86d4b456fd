"""Hypothesis strategies for the tuples of pure functions."""

from __future__ import annotations

import math

from hypothesis import strategies as st

from dq_marine.algebra.dual_quaternion import pose_from_parts

numbers = st.floats(-10.0, 10.0, allow_nan=False)
vectors = st.tuples(numbers, numbers, numbers)
quaternions = st.tuples(numbers, numbers, numbers, numbers)


def _unit(q):
    length = math.sqrt(sum(c * c for c in q))
    return tuple(c / length for c in q)


unit_quaternions = quaternions.filter(lambda q: sum(c * c for c in q) > 1e-3).map(_unit)
poses = st.builds(pose_from_parts, unit_quaternions, vectors)
