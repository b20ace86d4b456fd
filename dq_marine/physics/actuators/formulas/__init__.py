"""Formulas of actuators, as plain functions on tuples."""
