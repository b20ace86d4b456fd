"""Doors that make something new: scenes, environments, settings, weather, vehicles, sensors."""

from __future__ import annotations

import functools
import json
import tempfile
from collections.abc import Callable
from dataclasses import MISSING, Field, fields
from pathlib import Path
from typing import Any

import gymnasium as gym

import dq_marine
from dq_marine.envs.core.definition import TaskDefinition
from dq_marine.envs.core.making import make_single
from dq_marine.envs.core.marine_env import MarineEnv
from dq_marine.envs.core.registry import shipped_tasks
from dq_marine.vehicles import Vehicle, load_vehicle
from hostile.keywords import ENVIRONMENT, ID, SCENE, constant, number, one_of, vector3
from hostile.texts import changed_text
from hostile.values import Rng, arguments, spoilt


def drawn_scene(rng: Rng) -> Callable[[], Any]:
    given = arguments(rng, SCENE)
    return lambda: dq_marine.Scene(**given)


def drawn_environment(rng: Rng) -> Callable[[], Any]:
    given = arguments(rng, ENVIRONMENT)
    return lambda: MarineEnv(ID, **given)


def drawn_task_environment(rng: Rng) -> Callable[[], Any]:
    """An environment of any task by the task's own keywords, valid ones being its defaults and those of its levels."""
    tasks = shipped_tasks()
    task = tasks[rng.integers(len(tasks))]
    own = {one.name: one_of(*valid_values(task, one)) for one in fields(task.settings)}
    given = arguments(
        rng, own | {"level": one_of(None, *task.levels), "observation": one_of("numbers", "pixels")}
    )
    return lambda: make_single(task.id, **given)


def valid_values(task: TaskDefinition, keyword: Field[Any]) -> list[Any]:
    own = keyword.default if keyword.default is not MISSING else keyword.default_factory()  # type: ignore[misc]
    levels = [task.at_level(name, {}) for name in task.levels]
    return [own, *(level[keyword.name] for level in levels if keyword.name in level)]


def drawn_vector_environment(rng: Rng) -> Callable[[], Any]:
    own = {
        "num_envs": one_of(1, 3),
        "max_episode_steps": constant(100),
        "precision": one_of("float64", "float32"),
        "arithmetic": one_of("strict", "fast"),
        "threads": one_of(None, 1),
        "autoreset_mode": one_of("NextStep", "SameStep", "Disabled"),
    }
    given = {"num_envs": 2} | arguments(rng, ENVIRONMENT | own)
    return lambda: gym.make_vec(ID, **given)


def drawn_settings(rng: Rng) -> Callable[[], Any]:
    given = {name: spoilt(rng, draw(rng)) for name, draw in ENVIRONMENT.items() if rng.integers(4) == 0}
    kind = rng.integers(2)
    return lambda: (
        dq_marine.Settings(**given)
        if kind
        else dq_marine.Settings.from_json(
            json.dumps(given, default=lambda value: type(value).__name__, skipkeys=True)
        )
    )


MADE: dict[str, tuple[Callable[..., Any], dict[str, Callable[[Rng], Any]]]] = {
    "Jonswap": (
        dq_marine.Jonswap,
        {"height": number(0.1, 5.0), "period": number(3.0, 15.0), "gamma": number(1.0, 7.0)},
    ),
    "PiersonMoskowitz": (dq_marine.PiersonMoskowitz, {"wind_speed": number(2.0, 20.0)}),
    "ModifiedPiersonMoskowitz": (
        dq_marine.ModifiedPiersonMoskowitz,
        {"height": number(0.1, 5.0), "mean_period": number(3.0, 15.0)},
    ),
    "CurrentProfile": (
        dq_marine.CurrentProfile,
        {"depths": constant([0.0, 5.0, 20.0]), "velocities": constant([[1.0, 0.0], [0.5, 0.0], [0.0, 0.1]])},
    ),
    "GaussMarkovCurrent": (
        dq_marine.GaussMarkovCurrent,
        {"mean": vector3, "standard_deviation": number(0.0, 0.5), "correlation_time": number(1.0, 100.0)},
    ),
    "Windage": (
        dq_marine.Windage,
        {
            name: number(1.0, 9.0)
            for name in ("frontal_area", "lateral_area", "length", "height")
        },
    ),
    "Wind": (
        dq_marine.Wind,
        {
            "speed": number(0.0, 20.0),
            "direction_from": number(0.0, 6.0),
            "gusts": one_of(True, False),
            "components": constant(10),
        },
    ),
    "ellipsoid": (dq_marine.ellipsoid, {"a": number(0.1, 5.0), "b": number(0.1, 2.0), "c": number(0.1, 2.0)}),
    "spheroid": (dq_marine.spheroid, {"a": number(0.2, 5.0), "b": number(0.2, 2.0)}),
    "DVL": (dq_marine.DVL, {"seabed": number(10.0, 100.0), "reach": number(10.0, 100.0)}),
    "GNSS": (dq_marine.GNSS, {"surface": number(0.1, 1.0)}),
    "batch_of": (
        dq_marine.batch_of,
        {"scenes": lambda rng: [plain_scene()] * 2, "size": one_of(None, 2), "threads": one_of(None, 1)},
    ),
    "load_vehicle": (load_vehicle, {"vehicle": one_of("otter", "remus100")}),
    "Randomisation.load": (dq_marine.Randomisation.load, {"randomisation": one_of("default", "published")}),
}  # fmt: skip


@functools.cache
def plain_scene() -> dq_marine.Scene:
    return dq_marine.Scene("bluerov2_heavy")


def drawn_making(rng: Rng, name: str) -> Callable[[], Any]:
    make, valid = MADE[name]
    values = [spoilt(rng, draw(rng)) for draw in valid.values()]
    if rng.integers(2):
        return lambda: make(*values)
    given = dict(zip(valid, values, strict=True))
    return lambda: make(**given)


def drawn_sea(rng: Rng) -> Callable[[], Any]:
    spectrum = spoilt(rng, dq_marine.Jonswap(1.0, 7.0))
    given = arguments(
        rng,
        {
            "direction": number(0.0, 6.0),
            "components": one_of(5, 40),
            "seed": one_of(0, 1),
            "depth": number(5.0, 100.0),
        },
    )
    return lambda: dq_marine.Sea(spectrum, **given)


@functools.cache
def vehicle_content(name: str) -> str:
    return json.dumps(load_vehicle(name).model_dump(mode="json"))


def drawn_vehicle(rng: Rng) -> Callable[[], Any]:
    content = spoilt_deep(
        rng, json.loads(vehicle_content(("bluerov2_heavy", "otter", "remus100")[rng.integers(3)]))
    )
    return lambda: Vehicle.model_validate(content)


def spoilt_deep(rng: Rng, content: dict[str, Any]) -> Any:
    """A vehicle's content with one to three values spoilt somewhere in it."""
    for _ in range(rng.integers(1, 4)):
        place: Any = content
        while True:
            keys = list(place) if isinstance(place, dict) else list(range(len(place)))
            key = keys[rng.integers(len(keys))]
            if isinstance(place[key], dict | list) and place[key] and rng.integers(8):
                place = place[key]
                continue
            place[key] = spoilt(rng, place[key])
            break
    return content


def drawn_vehicle_file(rng: Rng) -> Callable[[], Any]:
    """A catalogue file with its text changed: bytes, lines, sections, numbers."""
    folder = Path(dq_marine.__file__).parent / "vehicles" / "catalogue"
    paths = sorted(folder.glob("*.toml"))
    text = paths[rng.integers(len(paths))].read_text()
    for _ in range(rng.integers(1, 4)):
        text = changed_text(rng, text)
    with tempfile.NamedTemporaryFile("w", suffix=".toml", delete=False, errors="surrogatepass") as file:
        file.write(text)

    def load() -> Any:
        try:
            return load_vehicle(file.name)
        finally:
            Path(file.name).unlink(missing_ok=True)

    return load
