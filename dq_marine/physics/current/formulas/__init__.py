"""Formulas of current, as plain functions on tuples."""
