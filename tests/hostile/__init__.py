"""Hostile input: values, the public doors that they are tried on, and what must hold of each case."""
