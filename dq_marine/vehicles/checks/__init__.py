"""Checks that a vehicle is physically possible."""
