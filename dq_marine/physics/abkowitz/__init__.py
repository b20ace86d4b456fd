"""A whole ship by polynomials about its service speed, as a table of a vehicle file and as a force."""
