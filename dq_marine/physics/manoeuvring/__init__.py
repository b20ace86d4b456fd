"""Manoeuvring of ships by the MMG model: hull, propeller and rudder."""
