"""Many bodies at once, in SIMD lanes."""
