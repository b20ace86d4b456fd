"""A free rigid body in MuJoCo: the only body of ours that it can represent exactly."""

from __future__ import annotations

import importlib
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

from dq_marine.report.cases import Case
from dq_marine.report.closed_forms import quaternion_matrix
from dq_marine.report.end_state import EndState
from dq_marine.report.physics import Physics
from dq_marine.util.extras import missing_library

Array = NDArray[np.float64]
Integrator: TypeAlias = Literal["Euler", "implicitfast", "RK4"]

MODEL = """
<mujoco>
  <option timestep="{step!r}" integrator="{integrator}" gravity="0 0 0">
    <flag constraint="disable" contact="disable" clampctrl="disable" warmstart="disable" filterparent="disable"
          actuation="disable" sensor="disable" eulerdamp="disable" autoreset="disable" island="disable"/>
  </option>
  <worldbody>
    <body>
      <freejoint/>
      <inertial pos="0 0 0" mass="{mass!r}" diaginertia="{inertia}"/>
    </body>
  </worldbody>
</mujoco>
"""


def refusal(case: Case) -> str:
    """Return why MuJoCo cannot represent a case, '' if it can."""
    physics = case.physics
    if acts(physics) or case.wrench.any():
        return "only a body that nothing acts on is the same in MuJoCo"
    mass = physics.mass_matrix
    moments = np.diag(mass)[3:]
    if (mass != np.diag(np.diag(mass))).any() or np.ptp(np.diag(mass)[:3]) > 0.0:
        return "MuJoCo has no inertia of added mass"
    if 2.0 * moments.max() > moments.sum():
        return "no rigid body has such moments of inertia"
    return ""


def acts(physics: Physics) -> bool:
    """Whether any force, or a current, acts on a body."""
    arrays = (physics.arm, physics.linear, physics.quadratic, physics.current_ned)
    return bool(physics.forces or physics.excess_weight or any(array.any() for array in arrays))


def load(case: Case, integrator: Integrator, step: float) -> tuple[Any, Any, Any]:
    """Return MuJoCo, a model and the data of a body at the start of a case.

    Raises:
        MissingDependencyError: MuJoCo is not installed.
    """
    try:
        mujoco = importlib.import_module("mujoco")
    except ModuleNotFoundError as error:
        raise missing_library("the comparison with MuJoCo", error.name, "bench") from error
    diagonal = np.diag(case.physics.mass_matrix)
    inertia = " ".join(map(repr, diagonal[3:].tolist()))
    text = MODEL.format(step=step, integrator=integrator, mass=float(diagonal[0]), inertia=inertia)
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    data.qpos[:] = np.concatenate([case.position, case.quaternion])
    velocity_ned = quaternion_matrix(case.quaternion) @ case.velocity[:3]
    data.qvel[:] = np.concatenate([velocity_ned, case.velocity[3:]])
    return mujoco, model, data


@contextmanager
def warnings_dropped(mujoco: Any) -> Iterator[None]:
    """Keep MuJoCo from printing that a motion blows up, and from a log file in the working folder."""
    before = mujoco.get_mju_user_warning()
    mujoco.set_mju_user_warning(lambda message: None)
    try:
        yield
    finally:
        mujoco.set_mju_user_warning(before)


def run(case: Case, integrator: Integrator, step: float) -> tuple[EndState, float]:
    """Return where a case ends after steps of about a size [s] that divides its duration, and the wall time [s]."""
    steps = max(1, round(case.duration / step))
    mujoco, model, data = load(case, integrator, case.duration / steps)
    with warnings_dropped(mujoco):
        begin = time.perf_counter()
        mujoco.mj_step(model, data, steps)
        seconds = time.perf_counter() - begin
    attitude = np.array(data.qpos[3:])
    velocity = quaternion_matrix(attitude).T @ data.qvel[:3]
    return EndState(np.array(data.qpos[:3]), attitude, np.concatenate([velocity, data.qvel[3:]])), seconds
