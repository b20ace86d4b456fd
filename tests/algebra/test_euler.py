"""Fossen's Euler angles against SciPy's."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from dq_marine.algebra.euler import quaternion_from_euler
from dq_marine.algebra.quaternion import rotation_matrix

angles = st.floats(-7.0, 7.0)


@given(angles, angles, angles)
def test_roll_pitch_and_heading_are_turns_about_x_then_y_then_z(roll, pitch, heading):
    ours = np.reshape(rotation_matrix(quaternion_from_euler(roll, pitch, heading)), (3, 3))
    assert np.allclose(ours, Rotation.from_euler("xyz", [roll, pitch, heading]).as_matrix(), atol=1e-14)
