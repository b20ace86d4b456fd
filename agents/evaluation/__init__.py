"""Evaluation, flights and their plots."""
