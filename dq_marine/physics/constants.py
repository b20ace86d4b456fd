"""Constants that several phenomena share."""

from __future__ import annotations

GRAVITY = 9.81
"""Acceleration of gravity [m/s^2] where nothing else is said.

The value that the published models of the catalogue were made with (MSS and the Python Vehicle Simulator use 9.81);
standard gravity is 9.80665.
"""
