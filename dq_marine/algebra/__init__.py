"""Vectors, matrices, quaternions, dual quaternions and screws as plain functions on tuples of components."""
