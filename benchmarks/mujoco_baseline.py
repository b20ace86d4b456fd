"""The baseline of the speed comparison: a vehicle's body in MuJoCo's water, set up to go as fast as MuJoCo can.

Run: python benchmarks/mujoco_baseline.py [--vehicle NAME] [--bodies N] [--threads N] [--steps N] [--json FILE]

Free bodies with MuJoCo's ellipsoid fluid model, net weight, righting moment and a held wrench, in float64. What makes
them fast, as measured against the alternatives:

- `mujoco.batch` advances many simulations in C and copies neither states nor wrenches in between, as a rollout does.
- Many bodies stand in one model and share what a call of mj_step costs at least, which for a single body is most of its
  time. They do not meet, for contacts are off, as is every other flag that is not needed.
- The free joint's origin is the centre of buoyancy. Buoyancy is then a constant generalised force with an exact moment;
  an actuator or a second body for it costs more.

Two things are in MuJoCo's favour. During a call a held force keeps its direction in the world rather than in the
body; motors on a site would turn with the body, and cost more. And MuJoCo's fluid knows the Coriolis forces of the
added mass, but not its inertia.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import time
from importlib.metadata import version
from pathlib import Path
from typing import Literal, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from dq_marine.physics.constants import GRAVITY
from dq_marine.physics.matrices import skew
from dq_marine.vehicles import Vehicle, load_vehicle

Array = NDArray[np.float64]
Integrator = Literal["Euler", "implicitfast", "RK4"]

INSTALL = "This benchmark needs MuJoCo 4: pip install 'mujoco>=4'"
STEP = 0.02  # s
VISCOSITY = 1.0e-3  # Pa s, water at 20 degrees
LARGEST_MODEL = 128  # bodies; the time per body is flat from 64 to 1024
REPEATS = 5
# Not "damper" as well: without "spring" and "damper" MuJoCo leaves out every passive force, the water's included.
DISABLED = (
    "constraint equality frictionloss limit contact spring clampctrl warmstart filterparent actuation refsafe sensor "
    "midphase eulerdamp autoreset nativeccd island multiccd"
)


class MujocoBaseline:
    """A batch of one vehicle's bodies in MuJoCo, at rest at first, pushed by nothing.

    Args:
        vehicle: whose mass, inertia, buoyancy and size the bodies have; their drag is MuJoCo's own.
        bodies: how many.
        threads: that step them, the caller's included.
        integrator: MuJoCo's name of it.
        bodies_per_model: a divisor of `bodies`; by default the fastest, and 1 for the usual one simulation a body.
        step: [s].

    Attributes:
        model: MuJoCo's, of `bodies_per_model` bodies.
    """

    def __init__(
        self,
        vehicle: Vehicle,
        bodies: int,
        threads: int,
        integrator: Integrator,
        bodies_per_model: int | None = None,
        step: float = STEP,
    ) -> None:
        try:
            from mujoco import MjModel
            from mujoco.batch import Batch
        except ImportError as error:
            raise ImportError(INSTALL) from error
        each = bodies_per_model or fastest_share(bodies, threads)
        models = bodies // each
        if models * each != bodies:
            raise ValueError(f"bodies_per_model must divide {bodies}, not {each}")
        self.bodies = bodies
        self.bodies_per_model = each
        self._vehicle = vehicle
        self.model = MjModel.from_xml_string(mjcf(vehicle, each, integrator, step))
        self._batch = Batch(self.model, models, threads)
        self._poses = self._batch.bind("qpos").reshape(models, each, 7)  # views, all three
        self._velocities = self._batch.bind("qvel").reshape(models, each, 6)
        self._forces = self._batch.bind("qfrc_applied").reshape(models, each, 6)
        self.push(np.zeros(6))

    @property
    def poses(self) -> Array:
        """Position of the centre of buoyancy, NED [m], and quaternion body to NED, shape (bodies, 7)."""
        return np.array(self._poses).reshape(self.bodies, 7)

    @property
    def velocities(self) -> Array:
        """Velocity of the centre of buoyancy, NED, and angular velocity, body [m/s, rad/s], shape (bodies, 6)."""
        return np.array(self._velocities).reshape(self.bodies, 6)

    @property
    def forces(self) -> Array:
        """Generalised forces held: force in NED, moment about the centre of buoyancy in body, shape (bodies, 6)."""
        return np.array(self._forces).reshape(self.bodies, 6)

    def place(self, poses: ArrayLike) -> None:
        """Put all bodies, at rest, at one pose or each at its own, as `poses` has them."""
        self._poses[...] = np.broadcast_to(poses, (self.bodies, 7)).reshape(self._poses.shape)
        self._velocities[...] = 0.0

    def push(self, wrench_body: ArrayLike) -> None:
        """Hold one wrench about the body origin [N, N m], or one for each body; the force turns with the next call."""
        wrench = np.broadcast_to(wrench_body, (self.bodies, 6))
        center = np.array(self._vehicle.buoyancy.center)
        force_ned = turned(self.poses[:, 3:], wrench[:, :3])
        force_ned[:, 2] -= self._vehicle.buoyant_force
        moment_body = wrench[:, 3:] - np.cross(center, wrench[:, :3])
        self._forces[...] = np.hstack([force_ned, moment_body]).reshape(self._forces.shape)

    def advance(self, steps: int) -> None:
        """Take some steps with all bodies."""
        self._batch.step(nstep=steps)


def fastest_share(bodies: int, threads: int) -> int:
    """Return how many bodies stand in one model: as many as are of use and leave every thread some models."""
    most = max(1, min(LARGEST_MODEL, bodies // threads))
    return next(share for share in range(most, 0, -1) if bodies % share == 0)


def mjcf(vehicle: Vehicle, bodies: int, integrator: Integrator, step: float) -> str:
    """Return the model of some bodies: world north-east-down, body forward-starboard-down about its buoyancy."""
    center, origin = np.array(vehicle.rigid_body.center_of_mass), np.array(vehicle.buoyancy.center)
    mass, inertia = vehicle.rigid_body.mass, central_inertia(vehicle)
    products = inertia[[0, 0, 1], [1, 2, 2]]
    moments = f'diaginertia="{vector(np.diag(inertia))}"'
    if products.any():
        moments = f'fullinertia="{vector(np.append(np.diag(inertia), products))}"'
    size = vehicle.dimensions
    semiaxes = 0.5 * np.array([size.length, size.width, size.height])
    flags = " ".join(f'{name}="disable"' for name in DISABLED.split())
    return f"""
<mujoco>
  <option timestep="{step}" integrator="{integrator}" gravity="0 0 {GRAVITY}"
          density="{vehicle.buoyancy.water_density}" viscosity="{VISCOSITY}">
    <flag {flags}/>
  </option>
  <worldbody>
    <replicate count="{bodies}">
      <body>
        <freejoint/>
        <inertial pos="{vector(center - origin)}" mass="{mass}" {moments}/>
        <geom type="ellipsoid" pos="{vector(-origin)}" size="{vector(semiaxes)}" fluidshape="ellipsoid"
              contype="0" conaffinity="0"/>
      </body>
    </replicate>
  </worldbody>
</mujoco>"""


def central_inertia(vehicle: Vehicle) -> Array:
    """Return the dry body's inertia about its centre of mass, shape (3, 3)."""
    s = skew(np.array(vehicle.rigid_body.center_of_mass))
    return np.asarray(vehicle.rigid_body_matrix[3:, 3:] + vehicle.rigid_body.mass * s @ s)


def vector(numbers: Array) -> str:
    """Return numbers as MJCF writes them."""
    return " ".join(repr(float(number)) for number in numbers)


def turned(quaternions: Array, vectors: Array) -> Array:
    """Return vectors turned by unit quaternions, row by row."""
    twice = 2.0 * np.cross(quaternions[:, 1:], vectors)
    return np.asarray(vectors + quaternions[:, :1] * twice + np.cross(quaternions[:, 1:], twice))


def check(vehicle: Vehicle, integrator: Integrator) -> None:
    """Raise AssertionError unless a body sinks, rights itself, and is driven as the vehicle's own numbers say.

    Net weight and righting moment must be right to the step's accuracy; the speed ahead only to a factor of three,
    since the drag is that of MuJoCo's ellipsoid.
    """
    baseline = MujocoBaseline(vehicle, 2, 1, integrator)
    baseline.advance(1)
    sinking = STEP * (vehicle.weight - vehicle.buoyant_force) / vehicle.rigid_body.mass
    np.testing.assert_allclose(baseline.velocities[:, 2], sinking, rtol=1e-2, err_msg="net weight")

    heeled = np.array([0.0, 0.0, 0.0, np.cos(0.1), np.sin(0.1), 0.0, 0.0])
    baseline.place(heeled)
    baseline.advance(1)
    down_body = turned(heeled[None, 3:] * [1.0, -1.0, -1.0, -1.0], np.array([[0.0, 0.0, 1.0]]))[0]
    arm = np.array(vehicle.buoyancy.center) - np.array(vehicle.rigid_body.center_of_mass)
    moment = np.cross(arm, -vehicle.buoyant_force * down_body)
    righting = STEP * np.linalg.solve(central_inertia(vehicle), moment)
    np.testing.assert_allclose(
        baseline.velocities[:, 3:],
        np.tile(righting, (2, 1)),
        rtol=1e-2,
        atol=1e-2 * np.abs(righting).max(),
        err_msg="righting moment",
    )

    speed = 0.1
    drag = vehicle.linear_damping[0, 0] * speed + vehicle.quadratic_damping[0] * speed**2
    baseline.place([0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0])
    baseline.push([drag, 0.0, 0.0, 0.0, 0.0, 0.0])
    baseline.advance(round(60.0 / STEP))
    ahead = baseline.velocities[:, 0]
    assert np.all((ahead > speed / 3) & (ahead < speed * 3)), f"surge at {ahead} m/s instead of about {speed}"


def seconds(baseline: MujocoBaseline, steps: int) -> float:
    """Return how long one call of `steps` steps takes."""
    start = time.perf_counter()
    baseline.advance(steps)
    return time.perf_counter() - start


def driven(
    vehicle: Vehicle, bodies: int, threads: int, integrator: Integrator, bodies_per_model: int | None = None
) -> MujocoBaseline:
    """Return bodies under way, each with a wrench of its own up to a tenth of the vehicle's limits."""
    baseline = MujocoBaseline(vehicle, bodies, threads, integrator, bodies_per_model)
    baseline.push(0.1 * vehicle.wrench_limits * np.random.default_rng(0).uniform(-1.0, 1.0, (bodies, 6)))
    baseline.advance(5)
    return baseline


def mujoco_steps_per_second(
    bodies: int,
    threads: int,
    integrator: Integrator,
    steps: int,
    vehicle: str = "bluerov2_heavy",
    bodies_per_model: int | None = None,
) -> float:
    """Return the steps of all bodies taken in a second, best of several calls after one to warm up."""
    baseline = driven(load_vehicle(vehicle), bodies, threads, integrator, bodies_per_model)
    best = min(seconds(baseline, steps) for _ in range(REPEATS))
    if not np.isfinite(baseline.velocities).all():
        raise RuntimeError(f"MuJoCo's {integrator} blew up, so that its speed says nothing")
    return bodies * steps / best


def main() -> None:
    """Check the motion, measure, print a table, and write the numbers if asked."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--vehicle", default="bluerov2_heavy", help="a catalogue name or a TOML file")
    parser.add_argument("--bodies", type=int, default=4096)
    parser.add_argument("--threads", type=int, default=os.cpu_count() or 1, help="beside 1")
    parser.add_argument("--steps", type=int, default=20, help="in one call")
    parser.add_argument("--json", type=Path, help="write the numbers to this file")
    arguments = parser.parse_args()
    bodies, steps = arguments.bodies, arguments.steps
    vehicle = load_vehicle(arguments.vehicle)
    layouts = {"fastest": None, "one body a model": 1}
    measured: dict[str, float] = {}
    try:
        for integrator in get_args(Integrator):
            check(vehicle, integrator)
    except ImportError as error:
        parser.exit(1, f"{error}\n")
    print(
        f"{platform.processor() or platform.machine()}; Python {platform.python_version()}, MuJoCo "
        f"{version('mujoco-core')}; {vehicle.name}, {bodies} bodies, {steps} steps a call"
    )
    print(f"{'':14}{'bodies in a model':>19}{'threads':>9}{'time a step':>13}{'steps':>15}")
    for integrator in get_args(Integrator):
        for layout, share in layouts.items():
            for threads in sorted({1, arguments.threads}):
                rate = mujoco_steps_per_second(bodies, threads, integrator, steps, arguments.vehicle, share)
                measured[f"{integrator}, {layout}, threads: {threads}"] = rate
                shown = share or fastest_share(bodies, threads)
                print(f"{integrator:14}{shown:>19}{threads:>9}{1e9 / rate:>10.0f} ns{rate:>13,.0f}/s")
    if arguments.json:
        arguments.json.write_text(json.dumps(measured, indent=2))


if __name__ == "__main__":
    main()
