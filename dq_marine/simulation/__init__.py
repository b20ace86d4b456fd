"""Scenes, and the bodies and batches of bodies that they make."""
