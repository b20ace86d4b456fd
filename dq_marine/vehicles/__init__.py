"""Marine vehicles: one TOML file each, read into frozen, validated models."""

from dq_marine.vehicles.catalogue import load_vehicle, vehicle_names
from dq_marine.vehicles.model import Vehicle

__all__ = ["Vehicle", "load_vehicle", "vehicle_names"]
