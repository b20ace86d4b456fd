"""A randomisation file, and the vehicles that are drawn from it."""

from __future__ import annotations

import functools
import os
from typing import Any

import numpy as np

from dq_marine.checks import whole_number
from dq_marine.errors import InvalidInputError
from dq_marine.physics.fields import Table
from dq_marine.randomisation.drawing import (
    check_lost,
    varied_actuators,
    varied_added_mass,
    varied_buoyancy,
    varied_damping,
    varied_rigid_body,
)
from dq_marine.randomisation.files import randomisation_names, read_file
from dq_marine.randomisation.tables import (
    ActuatorsDraw,
    AddedMassDraw,
    BuoyancyDraw,
    CurrentSpeed,
    DampingDraw,
    RigidBodyDraw,
)
from dq_marine.vehicles import Vehicle
from dq_marine.vehicles.validation import validated

ATTEMPTS = 100
"""Attempts to draw a vehicle that passes all checks."""

LARGEST_POOL = 100_000


class Randomisation(Table):
    """The numbers that are drawn, and their distributions.

    Attributes:
        description: one sentence.
        sources: where the ranges come from.
        rigid_body: mass and its distribution.
        buoyancy: displaced water.
        added_mass: M_A.
        damping: linear and quadratic.
        actuators: what they reach.
        current: for environments that are not told otherwise.
    """

    description: str = ""
    sources: tuple[str, ...] = ()
    rigid_body: RigidBodyDraw = RigidBodyDraw()
    buoyancy: BuoyancyDraw = BuoyancyDraw()
    added_mass: AddedMassDraw = AddedMassDraw()
    damping: DampingDraw = DampingDraw()
    actuators: ActuatorsDraw = ActuatorsDraw()
    current: CurrentSpeed | None = None

    @classmethod
    def load(cls, randomisation: Randomisation | str | os.PathLike[str] = "default") -> Randomisation:
        """Return a randomisation: one that ships by name, one from a TOML file, or the one given.

        Raises:
            InvalidInputError: no such name or file, or the file is wrong; the message lists field, value and remedy.
        """
        if isinstance(randomisation, Randomisation):
            return randomisation
        if not isinstance(randomisation, str | os.PathLike):
            raise InvalidInputError(
                f"randomisation is a {type(randomisation).__name__}; give a name ({', '.join(randomisation_names())}), "
                "the path of a .toml file, or a Randomisation"
            )
        return read_file(cls, randomisation)

    def draw(self, vehicle: Vehicle, rng: np.random.Generator | int) -> Vehicle:
        """Return a vehicle like the given one, which passes all checks of a vehicle file.

        Where the vehicle's added mass is positive semidefinite, as physics has it, the varied M is positive definite
        by construction, and damping takes energy wherever the vehicle's does: see `randomisation.congruence`. A draw
        that another check refuses, such as that of the mean density, is drawn again.

        Args:
            vehicle: the one to vary.
            rng: a generator, which goes on, or a seed.

        Raises:
            InvalidInputError: it would lose all its propellers; or none of a hundred draws passes, and the message says
                why the last one did not.
        """
        check_lost(self.actuators, vehicle)
        random = np.random.default_rng(rng)
        for _ in range(ATTEMPTS):
            try:
                return validated(self._drawn_content(vehicle, random), "the drawn vehicle")
            except InvalidInputError as error:
                refusal = str(error)
        raise InvalidInputError(
            f"none of {ATTEMPTS} draws from {vehicle.name!r} is a vehicle that can be; give narrower distributions. "
            f"The last one: {refusal}"
        )

    def pool(self, vehicle: Vehicle, size: int, seed: int = 0) -> tuple[Vehicle, ...]:
        """Return as many drawn vehicles as asked for; the first ones of a larger pool are those of a smaller one.

        Raises:
            InvalidInputError: see `draw`; or size or seed is no whole number, of 1 or more and 0 or more.
        """
        count = whole_number("the number of vehicles", size, least=1, most=LARGEST_POOL)
        start = whole_number("the vehicles' seed", seed, least=0)
        # A copy made in code may hold lists, which have no hash and which pydantic warns of.
        own = validated(vehicle.model_dump(warnings=False), vehicle.name)
        return _pool(self, own, count, start)

    def _drawn_content(self, vehicle: Vehicle, rng: np.random.Generator) -> dict[str, Any]:
        """Return a varied vehicle as its file would have it, not checked yet."""
        rigid_body = varied_rigid_body(self.rigid_body, vehicle.rigid_body, rng)
        return vehicle.model_dump() | {
            "rigid_body": rigid_body,
            **varied_buoyancy(self.buoyancy, vehicle, rigid_body, rng),
            **varied_damping(self.damping, vehicle, rng),
            **varied_actuators(self.actuators, vehicle, rng),
            **varied_added_mass(self.added_mass, vehicle, rng),
        }


@functools.lru_cache(maxsize=8)
def _pool(randomisation: Randomisation, vehicle: Vehicle, size: int, seed: int) -> tuple[Vehicle, ...]:
    """Return drawn vehicles, each from a generator of its own; environments made alike share them."""
    return tuple(randomisation.draw(vehicle, np.random.default_rng([seed, index])) for index in range(size))
