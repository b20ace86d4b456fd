"""Dynamic positioning: a PID controller of position and attitude, the baseline to compare with.

The wanted acceleration in each axis is linear in error e, velocity and the error's integral,

    a = k_p e + k_d (nu_goal - nu) + a_goal + z,    dz/dt = k_i e,                                     (1)

where a goal that stands still has nu_goal = a_goal = 0,

and the wrench is M a less the restoring wrench, with the vehicle's full mass matrix M: Fossen's nonlinear MIMO
PID (2021, Handbook of Marine Craft, Algorithm 15.2) but for two things. The full M takes the place of its diagonal,
and the third pole is placed, too: e obeys (s^2 + 2 zeta w s + w^2)(s + w_i) with

    k_p = w^2 + 2 zeta w w_i,    k_d = 2 zeta w + w_i,    k_i = w^2 w_i.                                (2)

Damping by the water is not cancelled: it only adds to k_d. The current is not measured: z makes up for it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from dq_marine.agents.controllers.reading import GOAL_POSE, Reading, goal_reader, read_goal_pose
from dq_marine.agents.controllers.rotation import both_halves, crossed
from dq_marine.agents.controllers.wrench_mapping import WRENCH_MAPPINGS, Given, WrenchMapping
from dq_marine.agents.environments import marine
from dq_marine.agents.preset_files import read_settings
from dq_marine.agents.settings import ControllerSettings, LoopSettings
from dq_marine.algebra.quaternion import world_down_in_body
from dq_marine.checks import one_of
from dq_marine.envs.core.marine_env import Action
from dq_marine.envs.core.observation import Observation
from dq_marine.errors import InvalidInputError
from dq_marine.vehicles import Vehicle

Array = NDArray[np.float64]

FAR = (0.1, 0.3)
"""An error at which the actuators may be at their limit: in position [vehicle lengths], in attitude [rad]."""

LEVEL_DOWN = np.array([0.0, 0.0, 1.0])
"""Down, seen from a level goal."""


@dataclass(frozen=True)
class Gains:
    """Gains of (1), per axis in Fossen's order, each of shape (6,) [1/s^2, 1/s, 1/s^3]."""

    proportional: Array
    derivative: Array
    integral: Array


def place_poles(settings: ControllerSettings) -> Gains:
    """Return the gains (2)."""
    w = _six(settings, "bandwidth")
    zeta = _six(settings, "damping_ratio")
    w_i = _six(settings, "integral_rate")
    return Gains(
        proportional=w**2 + 2.0 * zeta * w * w_i, derivative=2.0 * zeta * w + w_i, integral=w**2 * w_i
    )


def within_authority(settings: ControllerSettings, vehicle: Vehicle) -> ControllerSettings:
    """Return settings that are slowed down for a vehicle whose actuators are weak for its mass, such as a ship.

    With them an error of `FAR` asks for no more acceleration than the actuators give. The response is the same but for
    its time scale; a ship's position is wanted less exactly than that of an ROV, but its heading is not.
    """
    strength = vehicle.wrench_limits / np.diag(vehicle.mass_matrix)
    far = np.repeat([FAR[0] * vehicle.dimensions.length, FAR[1]], 3)
    fastest = np.sqrt(strength / far)
    rates = {}
    for name, axes in (("position", slice(3)), ("attitude", slice(3, 6))):
        loop: LoopSettings = getattr(settings, name)
        attainable = fastest[axes][fastest[axes] > 0.0]
        rates[name] = min(1.0, *(attainable / loop.bandwidth)) if attainable.size else 1.0
    return ControllerSettings(
        position=_slowed(
            settings.position, rates["position"], settings.position.integral_reach / rates["position"]
        ),
        attitude=_slowed(settings.attitude, rates["attitude"], settings.attitude.integral_reach),
        anti_windup_time=settings.anti_windup_time / min(rates.values()),
    )


def _slowed(loop: LoopSettings, rate: float, integral_reach: float) -> LoopSettings:
    return LoopSettings(
        bandwidth=rate * loop.bandwidth,
        damping_ratio=loop.damping_ratio,
        integral_rate=rate * loop.integral_rate,
        integral_reach=integral_reach,
    )


class DPController:
    """Brings a fully actuated vehicle to the goal that it observes and holds it there.

    The integral z is kept in the goal's axes, which stand still in the current while the vehicle turns. Two
    measures keep it from winding up: errors beyond a reach are integrated as that reach, and a saturated actuator
    feeds its shortfall back (back-calculation; Astrom & Rundqwist 1989, Integrator windup and how to avoid it), which
    brings z nearer to zero and never past it: a goal that is far away would else leave an integral against it behind.

    An axis without actuator is left alone; the task may then be beyond the vehicle.

    Attributes:
        settings: where the poles go, of vehicles whose actuators are strong enough.
    """

    READS: ClassVar[tuple[str, ...]] = GOAL_POSE

    def __init__(
        self,
        vehicle: Vehicle,
        control_period: float,
        settings: ControllerSettings | None = None,
        actuation: str = "wrench",
        read: Callable[[Observation], Reading] = read_goal_pose,
    ) -> None:
        """Derive the gains.

        Args:
            vehicle: its mass matrix, weight, buoyancy and limits are used.
            control_period: time between actions [s].
            settings: where the poles go; None reads the preset `dp_controller`.
            actuation: what the environment's action drives, see `dq_marine.Settings`.
            read: finds the goal in an observation; by default in its first numbers.

        Raises:
            InvalidInputError: the poles are too fast for the control period, or a value is wrong.
            MissingDependencyError: thrusters are to be driven, and SciPy is not installed.
        """
        self.settings = settings or read_settings("dp_controller", ControllerSettings)
        chosen = within_authority(self.settings, vehicle)
        self.vehicle = vehicle
        self.control_period = control_period
        self._read = read
        self.gains = place_poles(chosen)
        self._check_rate()
        self._anti_windup_rate = 1.0 / max(chosen.anti_windup_time, control_period)
        self._reaches = (chosen.position.integral_reach, chosen.attitude.integral_reach)
        self._mass_matrix = vehicle.mass_matrix
        self._inverse_mass_matrix = np.linalg.inv(self._mass_matrix)
        self._limits = vehicle.wrench_limits
        self._mapping = _mapping(actuation, vehicle)
        self._net_weight = vehicle.weight - vehicle.buoyant_force
        self._down_in_goal = LEVEL_DOWN
        self._integral_in_goal = np.zeros(6)

    @classmethod
    def for_env(cls, env: gym.Env[Any, Any], settings: ControllerSettings | None = None) -> DPController:
        """Return the controller for an environment's vehicle and control period.

        Raises:
            InvalidInputError: the environment shows something else.
        """
        inner = marine(env)
        read = goal_reader(inner)
        return cls(inner.vehicle, inner.control_period, settings, inner.scene.actuation, read)

    @property
    def integral_in_goal(self) -> Array:
        """z: acceleration that makes up for what is not modelled, in the goal's axes, shape (6,)."""
        return self._integral_in_goal.copy()

    def reset(self, env: gym.Env[Any, Any] | None = None) -> None:
        """Forget the integral and learn where down is.

        Args:
            env: tells how the goal is tilted, after its own reset; None stands for a level goal.

        Raises:
            InvalidInputError: the environment shows something else.
        """
        self._integral_in_goal = np.zeros(6)
        self._down_in_goal = LEVEL_DOWN
        if env is not None:
            goal = marine(env).snapshot().goal_quaternion_body_to_ned
            if goal is not None:
                self._down_in_goal = np.array(world_down_in_body(tuple(goal.tolist())))

    def act(self, observation: Observation) -> Action:
        """Return the action in [-1, 1], shape (n,), and advance the integral."""
        reading = self._read(observation)
        return self._given(reading, self.wrench(reading)).action.astype(np.float32)

    def steered(self, reading: Reading, by_hand: Array) -> Array:
        """Return the wrench in which some axes are given by hand, and advance the integral.

        Args:
            reading: of the pose to hold.
            by_hand: force or moment of each axis, shape (6,) [N, N m]; NaN leaves an axis to the controller.
        """
        wanted = np.where(np.isnan(by_hand), self.wrench(reading), by_hand)
        return self._given(reading, wanted).wrench_body

    def _given(self, reading: Reading, wanted: Array) -> Given:
        given = self._mapping.give(wanted, float(reading.velocity_body[0]))
        self._integrate(reading, given.wrench_body - wanted)
        return given

    def wrench(self, reading: Reading) -> Array:
        """Return the wrench wanted now, beyond the limits if need be, shape (6,) [N, N m]."""
        acceleration = (
            self.gains.proportional * reading.error_body
            + self.gains.derivative * (reading.goal_velocity_body - reading.velocity_body)
            + reading.goal_acceleration_body
            + both_halves(reading.goal_to_body, self._integral_in_goal)
        )
        wrench: Array = self._mass_matrix @ acceleration - self._restoring_wrench(reading.goal_to_body)
        return wrench

    def _restoring_wrench(self, goal_to_body: Array) -> Array:
        """Return the wrench of weight and buoyancy, shape (6,); see `physics.hydrostatics.formulas.submerged`."""
        down = goal_to_body @ self._down_in_goal
        return np.concatenate([self._net_weight * down, crossed(self.vehicle.restoring_arm, down)])

    def _integrate(self, reading: Reading, shortfall: Array) -> None:
        """Advance z by one control period; `shortfall` is the wrench given less the wrench wanted, shape (6,)."""
        linear, angular = reading.error_body[:3], reading.error_body[3:]
        within_reach = np.concatenate(
            [_shortened(linear, self._reaches[0]), _shortened(angular, self._reaches[1])]
        )
        gathered = self.gains.integral * within_reach
        change = np.where(  # what no actuator can make up for is not summed up
            self._limits == 0.0,
            0.0,
            self._relief(reading.goal_to_body, shortfall) + self.control_period * gathered,
        )
        self._integral_in_goal = self._integral_in_goal + both_halves(reading.goal_to_body.T, change)

    def _relief(self, goal_to_body: Array, shortfall: Array) -> Array:
        """Return what back-calculation adds to z in a control period, in body axes, shape (6,).

        It is cut off at zero in body axes, since that is where actuators saturate: an axis whose actuators are not
        at their limit keeps its share, whatever the goal's direction.
        """
        before = both_halves(goal_to_body, self._integral_in_goal)
        fed_back = self.control_period * self._anti_windup_rate * self._inverse_mass_matrix @ shortfall
        relieved: Array = np.clip(before + fed_back, np.minimum(before, 0.0), np.maximum(before, 0.0))
        return relieved - before

    def _check_rate(self) -> None:
        """A velocity loop held over a period T is stable for k_d T < 2 and even-tempered below 1."""
        fastest = float(self.gains.derivative.max())
        if fastest * self.control_period >= 1.0:
            raise InvalidInputError(
                f"control_period = {self.control_period:g} s is too long for the controller: 2 zeta w + w_i = "
                f"{fastest:.3g} 1/s times it must stay below 1; lower the bandwidth, or give a control period "
                f"below {1.0 / fastest:.3g} s"
            )


def _mapping(actuation: str, vehicle: Vehicle) -> WrenchMapping:
    """Return where wrenches go."""
    return WRENCH_MAPPINGS[one_of("actuation", actuation, WRENCH_MAPPINGS)](vehicle)


def _six(settings: ControllerSettings, field: str) -> Array:
    """Return a field of both loops for the six axes, shape (6,)."""

    def three(loop: LoopSettings) -> list[float]:
        return [float(getattr(loop, field))] * 3

    return np.array(three(settings.position) + three(settings.attitude))


def _shortened(a: Array, reach: float) -> Array:
    """Return a vector, shortened to a length of at most `reach`."""
    length = float(np.linalg.norm(a))
    return a if length <= reach else reach / length * a
