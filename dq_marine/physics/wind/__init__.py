"""Wind and its gusts."""
