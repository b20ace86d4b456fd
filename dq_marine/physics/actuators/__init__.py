"""Thrusters, azimuths and fins."""
