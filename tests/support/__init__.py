"""What tests share: bodies to step, and independent equations of motion to compare with."""
