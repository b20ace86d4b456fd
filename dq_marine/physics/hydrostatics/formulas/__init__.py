"""Formulas of hydrostatics, as plain functions on tuples."""
