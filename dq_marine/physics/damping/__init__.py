"""Linear, quadratic and coupled damping, and cross-flow drag."""
