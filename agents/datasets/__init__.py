"""What agents and people fly, as Minari datasets."""
