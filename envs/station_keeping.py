"""Station keeping: reach a goal pose and hold it in a current that the agent does not see.

Registered as `dq_marine/StationKeeping-v0`.
"""

from __future__ import annotations

import math
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dq_marine.checks import finite_array, finite_number, unit_quaternion
from dq_marine.envs.currents import EnvironmentCurrent
from dq_marine.envs.marine_env import MarineEnv
from dq_marine.envs.station_keeping_task import INTEGRAL_BOUND, SPEED_BOUND, TASK, Aim, Weights
from dq_marine.envs.vector_env import DQMarineVectorEnv
from dq_marine.envs.vehicle_pool import RandomisationChoice, VehicleDraw
from dq_marine.errors import InvalidInputError
from dq_marine.kernel.quaternion import Quaternion
from dq_marine.kernel.sensing import with_sensors
from dq_marine.kernel.task import Task
from dq_marine.kernel.vector3 import Vector3
from dq_marine.randomisation import Randomisation
from dq_marine.sensors import Sensors, nested_numbers, sensors_of, shown_bounds
from dq_marine.vehicles import Vehicle, load_vehicle

LARGEST_WORKSPACE = 1e4
"""Largest radius of the workspace [m]."""

LONG_VEHICLE = 1.5
"""Length [m] up to which radii that are not given are those below; beyond it they grow with the length."""

START_RADIUS = 2.0
WORKSPACE_RADIUS = 6.0
"""Of vehicles that are not long [m]."""

GOAL_DEPTH = 5.0
"""Of vehicles that do not float, where no goal is given [m]."""

SUCCESS_POSITION = 0.1
"""On station: distance to the goal [m] below which, with `SUCCESS_ATTITUDE`, `is_success` is True."""

SUCCESS_ATTITUDE = math.radians(5.0)
"""On station: attitude error [rad]."""


@dataclass(frozen=True)
class StationKeepingReward:
    """Weights and widths of the reward of one control period, for distance d, attitude error e and action a.

    r = position exp(-(d/position_width)^2) + precision exp(-d/precision_width)
        + attitude exp(-e/attitude_width) - effort mean(a^2)

    The first and third terms are MarineGym's pose-hold reward; the second keeps a gradient where the first is
    flat; the small effort weight follows the finding that a large one stops learning.

    Attributes:
        position: weight of being near.
        position_width: distance [m] at which nearness counts 1/e.
        precision: weight of being at the goal.
        precision_width: distance [m] at which precision counts 1/e.
        attitude: weight of pointing as asked.
        attitude_width: angle [rad] at which it counts 1/e.
        effort: weight of the mean square of the action.
    """

    position: float = 0.5
    position_width: float = 1.0
    precision: float = 0.3
    precision_width: float = 0.1
    attitude: float = 0.2
    attitude_width: float = 0.5
    effort: float = 0.02

    def __post_init__(self) -> None:
        """Refuse weights and widths that no reward can have."""
        for field in fields(self):
            value = finite_number(f"reward.{field.name}", getattr(self, field.name))
            limit = "above 0" if field.name.endswith("_width") else "0 or more"
            if value < 0.0 or (value == 0.0 and field.name.endswith("_width")):
                raise InvalidInputError(f"reward.{field.name} = {value:g}; give a number {limit}")


class StationKeepingEnv(MarineEnv):
    """Reach a goal pose and hold it in an unseen current.

    Action: Box(-1, 1, (n,)), the thrust and torque of the n actuated axes, in the order surge, sway, heave, roll,
    pitch, yaw, over the vehicle's limits; or with `actuation="thrusters"` the commands of the n channels of its
    actuators in the order of `Vehicle.channels`, each over its limit on that side. Beyond the box it saturates.

    Observation: see `station_keeping_task.observe`, 18 numbers in SI units; with `sensors` of the measured motion, and
    followed by the age of each sensor's reading [s] (up to 60) and what else it shows. `info` has `position_error` [m],
    `attitude_error` [rad] and `is_success`; after a refused step also `integration`.

    An episode ends (terminated) beyond `workspace_radius` or at a refused step; `gym.make` truncates it after 300
    control periods, 30 s.
    """

    def __init__(
        self,
        vehicle: Vehicle | str | os.PathLike[str] = "bluerov2_heavy",
        *,
        current: EnvironmentCurrent | None = None,
        control_period: float = 0.1,
        substeps: int = 4,
        scheme: str = "midpoint",
        hydrostatics: str = "linear",
        actuation: str = "wrench",
        weather: Sequence[Any] = (),
        reward: StationKeepingReward | Mapping[str, float] | None = None,
        goal_position: Sequence[float] | None = None,
        start_radius: float | None = None,
        workspace_radius: float | None = None,
        sensors: Sensors = None,
        render_mode: str | None = None,
        record: bool = False,
        randomise: RandomisationChoice | None = None,
        vehicle_pool: int = 256,
        vehicle_seed: int = 0,
    ) -> None:
        """Check and compose the environment.

        Args:
            vehicle: a catalogue name, the path of a TOML file, or a `Vehicle`.
            current: a speed [m/s]: each episode draws a horizontal current of up to it, of any direction; or
                three numbers: this current in NED, always; or a `dq_marine.currents.CurrentProfile` or
                `GaussMarkovCurrent`, or a dictionary of its attributes. None: a speed, that of `randomise` or 0.3 m/s.
            control_period: time between actions [s].
            substeps: integrator steps in a control period.
            scheme: the integrator's drift, by name.
            hydrostatics: "linear", or "hull" for buoyancy at any depth and attitude: see `dq_marine.scene.Scene`.
            actuation: "wrench" or "thrusters": what an action drives; thrusters, azimuths and fins are at rest when an
                episode begins.
            reward: weights and widths, as a `StationKeepingReward` or a dictionary of its fields.
            goal_position: in NED [m]; None for (0, 0, 5), or where a vessel that floats is at rest.
            start_radius: episodes start within this distance of the goal [m], one in ten at the goal itself; a vessel
                that floats starts level with it. None for 2 m, growing with the length of vehicles above 1.5 m.
            workspace_radius: episodes end beyond this distance from the goal [m]; None for 6 m, growing likewise.
            weather: seas and winds, as objects or dictionaries: see `dq_marine.weather.weather_of`. Where they change,
                each episode begins at another time of theirs, which is drawn.
            sensors: what the agent is told by, see `dq_marine.sensors`: "auv", a list of sensors, or a dictionary; None
                for the motion as it is.
            render_mode: None, "human" (live page) or "rgb_array" (pictures).
            record: keep the episode for `save_html`.
            randomise: let each episode fly another vehicle, drawn as a randomisation says: "default", the name of
                another one that ships, the path of a TOML file, or a `dq_marine.randomisation.Randomisation`.
            vehicle_pool: how many vehicles are drawn beforehand; each episode takes one of them.
            vehicle_seed: of these draws: environments of one seed share their vehicles.

        Raises:
            InvalidInputError: a value is wrong.
            VehicleFileError: the vehicle file is wrong.
        """
        self.reward = _reward(reward)
        loaded = load_vehicle(vehicle)
        goal = _default_goal(loaded) if goal_position is None else goal_position
        self.goal_position_ned = finite_array("goal_position", goal, 3)
        workspace = _default_workspace(loaded) if workspace_radius is None else workspace_radius
        self.workspace_radius = finite_number("workspace_radius", workspace, above=0.0)
        start = _default_start(loaded, self.workspace_radius) if start_radius is None else start_radius
        self.start_radius = finite_number("start_radius", start)
        if self.workspace_radius > LARGEST_WORKSPACE:
            raise InvalidInputError(
                f"workspace_radius = {self.workspace_radius:g} m; give at most {LARGEST_WORKSPACE:g} m, within which "
                "float32 observations resolve the goal"
            )
        if not 0.0 <= self.start_radius < self.workspace_radius:
            raise InvalidInputError(
                f"start_radius = {self.start_radius:g} m; give 0 or more and less than the workspace_radius, "
                f"{self.workspace_radius:g} m"
            )
        self.sensors = sensors_of(sensors)
        randomisation = None if randomise is None else Randomisation.load(randomise)
        draw = VehicleDraw(randomisation, vehicle_pool, vehicle_seed)
        super().__init__(
            loaded,
            current=draw.current_or_default(current),
            control_period=control_period,
            substeps=substeps,
            scheme=scheme,
            hydrostatics=hydrostatics,
            actuation=actuation,
            weather=weather,
            render_mode=render_mode,
            record=record,
            vehicle_draw=draw,
        )

    def own_task(self) -> Task:
        """Return the formulas, told by sensors if there are any."""
        instruments = tuple(one.instrument for one in self.sensors)
        return with_sensors(TASK, instruments) if instruments else TASK

    @property
    def observation_bound(self) -> NDArray[np.float32]:
        """Largest magnitude of each observed number, shape (18,) or more."""
        rotated_integral = math.sqrt(3.0) * INTEGRAL_BOUND
        bounds = [
            *[self.workspace_radius] * 3,
            *[1.0] * 6,
            *[SPEED_BOUND] * 6,
            *[rotated_integral * (1.0 + 1e-6)] * 3,
            *shown_bounds(self.sensors),
        ]
        return np.array(bounds, dtype=np.float32)

    def new_aim(self, options: dict[str, Any]) -> Aim:
        """Return the task's parameters for the episode: upright goal, heading north unless asked otherwise."""
        position = finite_array(
            "options['goal_position']", options.get("goal_position", self.goal_position_ned), 3
        )
        q = unit_quaternion(
            "options['goal_quaternion']", options.get("goal_quaternion", (1.0, 0.0, 0.0, 0.0))
        )
        x, y, z = position.tolist()
        q0, q1, q2, q3 = q.tolist()
        return Aim(
            (x, y, z),
            (q0, q1, q2, q3),
            self.start_radius,
            1.0 if self.vehicle.hydrostatics is None else 0.0,
            self.workspace_radius,
            self.control_period,
            axes=float(len(self.drive.places)),
            weights=Weights(
                **{field.name: float(getattr(self.reward, field.name)) for field in fields(self.reward)}
            ),
            sensors=nested_numbers(self.sensors, self.control_period),
            **self.vehicle_aim(self.vehicle),
        )

    def goal_pose(self, aim: Aim) -> tuple[Vector3, Quaternion]:
        """Return the goal's position and attitude, for drawing."""
        return aim.position_ned, aim.attitude

    def succeeds(self, measures: dict[str, Any]) -> Any:
        """Whether the vehicle is on station."""
        near = measures["position_error"] < SUCCESS_POSITION
        return near & (measures["attitude_error"] < SUCCESS_ATTITUDE)


def _default_goal(vehicle: Vehicle) -> tuple[float, float, float]:
    return (0.0, 0.0, GOAL_DEPTH if vehicle.hydrostatics is None else vehicle.equilibrium_depth)


def _default_workspace(vehicle: Vehicle) -> float:
    return min(LARGEST_WORKSPACE, WORKSPACE_RADIUS * _lengths(vehicle))


def _default_start(vehicle: Vehicle, workspace_radius: float) -> float:
    """Return the default start radius [m], that of a short vehicle where the workspace is too small for more."""
    return min(START_RADIUS * _lengths(vehicle), max(START_RADIUS, workspace_radius / 3.0))


def _lengths(vehicle: Vehicle) -> float:
    """Return the vehicle's length over `LONG_VEHICLE`, 1 at least."""
    return max(1.0, vehicle.dimensions.length / LONG_VEHICLE)


def _reward(reward: StationKeepingReward | Mapping[str, float] | None) -> StationKeepingReward:
    """Return the reward's weights from whatever form they were given in."""
    if reward is None:
        return StationKeepingReward()
    if isinstance(reward, StationKeepingReward):
        return reward
    known = [field.name for field in fields(StationKeepingReward)]
    if not isinstance(reward, Mapping):
        raise InvalidInputError(
            f"reward = {reward!r}; give a StationKeepingReward or a dictionary with keys among {known}"
        )
    unknown = sorted(set(reward) - set(known))
    if unknown:
        raise InvalidInputError(f"reward has unknown keys {unknown}; it takes {known}")
    return StationKeepingReward(**reward)


class StationKeepingVectorEnv(DQMarineVectorEnv):
    """Many `StationKeepingEnv` at once; see `DQMarineVectorEnv`."""

    single_class = StationKeepingEnv
