"""Formulas of the whole-ship model, as plain functions on tuples."""
