"""Moving water: uniform, sheared over depth, and changing with time."""
