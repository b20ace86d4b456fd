"""Identification: a vehicle's numbers from logged motion."""

from dq_marine.identification.fit import Conditions, Fit, fit_vehicle
from dq_marine.identification.log import Log, read_log
from dq_marine.identification.parameters import DEFAULT_GROUPS, GROUPS

__all__ = ["DEFAULT_GROUPS", "GROUPS", "Conditions", "Fit", "Log", "fit_vehicle", "read_log"]
