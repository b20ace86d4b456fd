"""Baseline controllers, training with Stable-Baselines3, evaluation and flights.

The controllers, the evaluation and the flights need only what the environments need. Training and trained
policies need the extra: pip install "dq-marine[agents]".
"""
