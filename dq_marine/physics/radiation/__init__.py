"""Radiation memory: the waves that a hull makes, from its added mass and damping by frequency."""
