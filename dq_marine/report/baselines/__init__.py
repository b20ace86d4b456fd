"""Other integrators of the same equations, for comparison: what simulators and textbooks use."""
