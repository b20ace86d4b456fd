"""Marine vehicles: one TOML file each, read into frozen, validated models; ellipsoids of any size; their sheets."""

from dq_marine.vehicles.catalogue import load_vehicle, vehicle_names
from dq_marine.vehicles.ellipsoids import ellipsoid, spheroid
from dq_marine.vehicles.model import Vehicle
from dq_marine.vehicles.sheet import Sheet, vehicle_sheet

__all__ = ["Sheet", "Vehicle", "ellipsoid", "load_vehicle", "spheroid", "vehicle_names", "vehicle_sheet"]
