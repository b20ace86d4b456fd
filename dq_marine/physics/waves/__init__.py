"""Seas: spectra, kinematics, and the forces of waves."""
