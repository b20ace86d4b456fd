"""Shapes of vehicles."""
