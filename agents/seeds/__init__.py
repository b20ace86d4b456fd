"""One training with several seeds: a folder of run folders, one after the other, side by side, or on a cluster."""
