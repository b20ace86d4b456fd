"""Controllers, and agents by name."""
