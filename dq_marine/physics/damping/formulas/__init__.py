"""Formulas of damping, as plain functions on tuples."""
