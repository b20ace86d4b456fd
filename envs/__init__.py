"""Gymnasium environments. Importing `dq_marine` registers them."""
