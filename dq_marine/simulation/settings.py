"""What a simulation is made of, checked once: scenes, environments and the command line are built from it."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from typing import Any, TypeAlias, TypedDict

from dq_marine.checks import finite_number, one_of, positive_integer, whole_number
from dq_marine.errors import InvalidInputError, UnknownKeywordError
from dq_marine.physics.actuators.build import ACTUATIONS
from dq_marine.physics.current.build import Current, CurrentLike, current_of, plain
from dq_marine.physics.hydrostatics.build import checked_hydrostatics
from dq_marine.physics.radiation.build import checked_radiation
from dq_marine.physics.term import ForceTerm, checked_forces
from dq_marine.physics.weather.choice import plain_weather, weather_of
from dq_marine.randomisation import Randomisation
from dq_marine.randomisation.model import LARGEST_POOL
from dq_marine.simulation.assembly import check_method
from dq_marine.simulation.solids import plain_solids, solids_of
from dq_marine.task.sensors.build import Sensors, plain_sensors, sensors_of
from dq_marine.task.sensors.sensor import Sensor
from dq_marine.vehicles import Vehicle, load_vehicle
from dq_marine.vehicles.loading import plain_vehicle
from dq_marine.vehicles.validation import validated

KICKS = ("l_stable", "implicit_node")
"""How damping is taken in, by name."""

MOST_SUBSTEPS = 10_000
"""Integrator steps in a control period: more would hold the process for long, and never be needed."""

MOST_DELAY = 10
"""Control periods by which actions or observations may be late: they are part of an episode's memory, and more would
take long to compile."""

DEFAULT_CURRENT = 0.3
"""Largest speed of the current [m/s] that environments draw where nothing is said."""

VehicleLike: TypeAlias = Vehicle | str | os.PathLike[str]
RandomisationLike: TypeAlias = Randomisation | str | os.PathLike[str]


class SettingsKeywords(TypedDict, total=False):
    """The keywords of everything that is made from `Settings`, which says what they mean; `vehicle` apart."""

    current: float | CurrentLike | None
    weather: Sequence[Any]
    forces: Sequence[ForceTerm]
    solids: Sequence[Any]
    gravity: float | None
    actuation: str
    hydrostatics: str
    radiation: str
    scheme: str
    order: int
    kick: str
    control_period: float
    substeps: int
    sensors: Sensors
    action_delay: int
    observation_delay: int
    randomise: RandomisationLike | None
    vehicle_pool: int
    vehicle_seed: int


@dataclass(frozen=True)
class Settings:
    """A vehicle in water, how it is driven and seen, and how it is integrated.

    Whatever form a value is given in, the attribute holds the checked object.

    Attributes:
        vehicle: a catalogue name, the path of a TOML file, or a `Vehicle`.
        current: three components in NED [m/s]; a `CurrentProfile` or `GaussMarkovCurrent`, or a dictionary of its
            attributes; or one number, the largest speed [m/s] of a current that an environment draws for each
            episode. None: what the randomisation says, else 0.3 m/s.
        weather: seas and winds, as objects or dictionaries: see `dq_marine.physics.weather.weather_of`.
        forces: your own, see `dq_marine.ForceTerm`.
        solids: what the hull cannot pass: seabed, walls, pillars, meshes, as objects or dictionaries: see
            `dq_marine.simulation.solids.solids_of`.
        gravity: its acceleration [m/s^2]; None for what the vehicle's file says, 9.81 by default.
        actuation: "wrench", a force and a moment on the body; or "thrusters", the vehicle's thrusters, azimuths and
            fins, with their limits and lags.
        hydrostatics: "linear": the restoring force of a floating vessel's waterplane for small motions, and weight and
            buoyancy of any other vehicle; or "hull": the buoyancy of the boxes of its hull at any depth and
            attitude, so that it may capsize, dive or leave the water.
        radiation: how the waves that a hull makes act on it: "constant", by constant added mass and damping; or
            "memory", by those of all frequencies that its file has, for small speeds. See `dq_marine.Scene`.
        scheme: "midpoint"; "paper" for that of Xu and Halse; "galerkin" for the variational integrators whose orders
            above 2 need no substeps; "gauss" for collocation on the momentum: without damping exact in momentum
            and energy but not variational, with damping L-stable; or "runge_kutta" for an explicit method, the
            cheapest for a batch that is to be exact and is not stiff.
        order: of the method: 2 or 4, and 6 or 8 where nothing takes energy, or with "galerkin"; 6 or 8 of "gauss",
            where 8 is of order 7 with damping; 4 or 8 of "runge_kutta".
        kick: "l_stable", or "implicit_node", which keeps the step symmetric but rings under stiff damping.
        control_period: time between actions [s].
        substeps: integrator steps in a control period.
        sensors: what an agent is told by, see `dq_marine.task.sensors.build`: "auv", a list of sensors, or a
            dictionary; None for the motion as it is.
        action_delay: control periods after which an action reaches the vehicle; until the first does, none drives it.
        observation_delay: control periods by which what an agent is shown is old; at an episode's start it is shown the
            first observation until there is an older one. Rewards and `info` are of now.
        randomise: lets each episode fly another vehicle, drawn as a randomisation says: "default", the name of another
            one that ships, the path of a TOML file, or a `Randomisation`.
        vehicle_pool: how many vehicles are drawn beforehand; each episode takes one of them.
        vehicle_seed: of these draws: environments of one seed share their vehicles.

    Raises:
        InvalidInputError: a value is wrong; the message names it, the limit and the remedy.
        VehicleFileError: the vehicle file is wrong.
    """

    vehicle: VehicleLike = "bluerov2_heavy"
    current: float | CurrentLike | None = (0.0, 0.0, 0.0)
    weather: Sequence[Any] = ()
    forces: Sequence[ForceTerm] = ()
    solids: Sequence[Any] = ()
    gravity: float | None = None
    actuation: str = "wrench"
    hydrostatics: str = "linear"
    radiation: str = "constant"
    scheme: str = "midpoint"
    order: int = 2
    kick: str = "l_stable"
    control_period: float = 0.1
    substeps: int = 4
    sensors: Sensors = None
    action_delay: int = 0
    observation_delay: int = 0
    randomise: RandomisationLike | None = None
    vehicle_pool: int = 256
    vehicle_seed: int = 0

    def __post_init__(self) -> None:
        """Check every value and keep the checked one."""
        randomisation = None if self.randomise is None else Randomisation.load(self.randomise)
        loaded = load_vehicle(self.vehicle)
        checked = {
            "vehicle": loaded if self.gravity is None else loaded.in_gravity(self.gravity),
            "randomise": randomisation,
            "current": current_of(self._given_current(randomisation)),
            "weather": weather_of(self.weather),
            "forces": checked_forces(self.forces),
            "solids": solids_of(self.solids),
            "control_period": finite_number("control_period", self.control_period),
            "substeps": positive_integer("substeps", self.substeps),
            "sensors": sensors_of(self.sensors),
            "action_delay": whole_number("action_delay", self.action_delay, least=0, most=MOST_DELAY),
            "observation_delay": whole_number(
                "observation_delay", self.observation_delay, least=0, most=MOST_DELAY
            ),
            "vehicle_pool": positive_integer("vehicle_pool", self.vehicle_pool),
            "vehicle_seed": whole_number("vehicle_seed", self.vehicle_seed, least=0),
        }
        for name, value in checked.items():
            object.__setattr__(self, name, value)
        if self.substeps > MOST_SUBSTEPS:
            raise InvalidInputError(f"substeps = {self.substeps}; give at most {MOST_SUBSTEPS}")
        if self.vehicle_pool > LARGEST_POOL:
            raise InvalidInputError(f"vehicle_pool = {self.vehicle_pool}; give at most {LARGEST_POOL}")
        check_method(self.scheme, self.order)
        one_of("kick", self.kick, KICKS)
        one_of("actuation", self.actuation, ACTUATIONS)
        checked_hydrostatics(self.hydrostatics, self.flown)
        checked_radiation(self.radiation, self.flown)

    def _given_current(self, randomisation: Randomisation | None) -> Any:
        if self.current is not None:
            return self.current
        if randomisation is None or randomisation.current is None:
            return DEFAULT_CURRENT
        return randomisation.current.speed

    @classmethod
    def of(cls, **keywords: Any) -> Settings:
        """Return settings from keywords.

        Raises:
            UnknownKeywordError: a keyword is unknown.
            InvalidInputError: a value is wrong.
        """
        known = [field.name for field in fields(cls)]
        unknown = sorted(set(keywords) - set(known))
        if unknown:
            raise UnknownKeywordError.of("Settings", unknown, f"there are {known}")
        return cls(**keywords)

    @property
    def flown(self) -> Vehicle:
        """The vehicle, as an object."""
        assert isinstance(self.vehicle, Vehicle)  # noqa: S101 - told to the type checker: made so above
        return self.vehicle

    @property
    def water(self) -> Current:
        """The current, as an object."""
        return self.current  # type: ignore[return-value]

    @property
    def sensor_list(self) -> tuple[Sensor, ...]:
        """The sensors, as objects."""
        return self.sensors  # type: ignore[return-value]

    @property
    def step(self) -> float:
        """Step size h [s]."""
        return self.control_period / self.substeps

    def to_dict(self) -> dict[str, Any]:
        """Return the settings as text, lists and numbers, which `from_dict` takes.

        Raises:
            InvalidInputError: there are forces or transfer functions, which no JSON can say.
        """
        if self.forces:
            names = [force.name for force in self.forces]
            raise InvalidInputError(f"forces = {names} are functions; settings with forces have no JSON")
        values = {field.name: getattr(self, field.name) for field in fields(self)}
        randomise = None if self.randomise is None else Randomisation.load(self.randomise)
        return values | {
            "vehicle": plain_vehicle(self.flown),
            "current": plain(self.water),
            "weather": plain_weather(self.weather),
            "forces": [],
            "solids": plain_solids(self.solids),
            "sensors": plain_sensors(self.sensor_list),
            "randomise": None if randomise is None else randomise.model_dump(mode="json"),
        }

    @classmethod
    def from_dict(cls, values: Mapping[str, Any]) -> Settings:
        """Return the settings that `to_dict` gave.

        Raises:
            InvalidInputError: an entry is unknown or wrong.
        """
        given = dict(values)
        if isinstance(given.get("vehicle"), Mapping):
            given["vehicle"] = validated(given["vehicle"], "vehicle")
        if isinstance(given.get("randomise"), Mapping):
            given["randomise"] = Randomisation.model_validate(given["randomise"])
        return cls.of(**given)

    def to_json(self) -> str:
        """Return the settings as JSON; see `to_dict`."""
        return json.dumps(self.to_dict(), indent=2)

    @classmethod
    def from_json(cls, text: str) -> Settings:
        """Return the settings that `to_json` wrote.

        Raises:
            InvalidInputError: the text is no JSON object, or an entry is unknown or wrong.
        """
        try:
            values = json.loads(text)
        except json.JSONDecodeError as error:
            raise InvalidInputError(f"the settings are no JSON: {error}") from error
        if not isinstance(values, dict):
            raise InvalidInputError(f"the settings are a {type(values).__name__}; give a JSON object")
        return cls.from_dict(values)

    def with_vehicle(self, vehicle: Vehicle) -> Settings:
        """Return the same settings for another vehicle."""
        return replace(self, vehicle=vehicle)
