"""Environments by their classes, for tests that need no wrappers."""

from __future__ import annotations

from functools import partial

from dq_marine.envs.core.marine_env import MarineEnv
from dq_marine.envs.vector.vector_env import MarineVectorEnv

STATION_KEEPING = "dq_marine/StationKeeping-v0"
WAYPOINT_TRACKING = "dq_marine/WaypointTracking-v0"

StationKeepingEnv = partial(MarineEnv, STATION_KEEPING)
StationKeepingVectorEnv = partial(MarineVectorEnv, STATION_KEEPING)
