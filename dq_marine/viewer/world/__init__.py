"""What is drawn around a vehicle: sea, water, arrows, trail, camera."""
