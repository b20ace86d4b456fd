"""Weight and buoyancy: under water, on a waterplane, of a hull of boxes."""
