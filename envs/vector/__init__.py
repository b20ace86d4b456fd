"""Many environments at once, in SIMD lanes."""
