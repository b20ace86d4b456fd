"""How the kernel is run: compiled for one body."""
