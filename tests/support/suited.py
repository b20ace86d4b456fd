"""Every task of the package with every vehicle that it suits, as the registry tells: so none of them is forgotten."""

from dq_marine.envs.core.registry import shipped_tasks
from dq_marine.vehicles import load_vehicle, vehicle_names

FLEET = {name: load_vehicle(name) for name in vehicle_names()}

SUITED = [
    (task.id, name)
    for name, vehicle in FLEET.items()
    for task in shipped_tasks()
    if task.unsuitable(vehicle) is None
]
"""Pairs of a task's id and a vehicle's name."""
