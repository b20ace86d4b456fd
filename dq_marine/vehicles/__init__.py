"""Marine vehicles: one TOML file each, read into frozen, validated models; ellipsoids of any size; their sheets."""

from dq_marine.vehicles.analysis.ellipsoids import ellipsoid, spheroid
from dq_marine.vehicles.analysis.sheet import Sheet, vehicle_sheet
from dq_marine.vehicles.appearance import Appearance
from dq_marine.vehicles.loading import load_vehicle, vehicle_names
from dq_marine.vehicles.model import Vehicle

__all__ = [
    "Appearance",
    "Sheet",
    "Vehicle",
    "ellipsoid",
    "load_vehicle",
    "spheroid",
    "vehicle_names",
    "vehicle_sheet",
]
