"""Pure functions of the MMG model."""
