"""Pure mathematics on tuples of components: what one body does in one step.

Nothing here allocates, checks, raises or imports anything beyond this package and `math`. Every function
takes and returns scalars and tuples of scalars, so that the same text runs in plain Python, compiled for one
body, in SIMD lanes, or on tensors. How it is run is the business of `dq_marine.engines`.

Conventions: world frame NED (z down), body frame forward-starboard-down, SI units. Spatial vectors hold the
angular part first (the order of Xu & Halse, arXiv 1611.00616); Fossen's order stays at the public doors.
"""
