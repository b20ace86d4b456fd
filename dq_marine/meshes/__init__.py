"""Vehicles made from a mesh of their hull: hydrostatics exactly, added mass by a panel method, damping by estimates."""

from dq_marine.meshes.choices import Choices
from dq_marine.meshes.writing import vehicle_from_mesh

__all__ = ["Choices", "vehicle_from_mesh"]
