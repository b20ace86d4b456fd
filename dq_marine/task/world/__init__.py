"""What surrounds a vehicle: signed distances to shapes, rays cast at them, beams, a seabed, and fields of pillars.

All are pure functions, compiled for one body and for lanes. A world is nothing but numbers in the memory of a task.
"""
