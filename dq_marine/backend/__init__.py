"""How pure functions are run: compiled by Numba, for one body or for many."""
