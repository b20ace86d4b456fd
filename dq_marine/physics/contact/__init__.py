"""What is solid in the water, and how a hull that touches it is pushed back."""
