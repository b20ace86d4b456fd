"""Formulas of waves, as plain functions on tuples."""
