"""Flights that a person takes part in, by the panel of a live page."""
