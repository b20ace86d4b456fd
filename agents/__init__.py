"""Baseline controllers, training with Stable-Baselines3, evaluation and flights.

The public names stand in `__init__.pyi`, one line each, and are imported on first use. The controllers, the
evaluation and the flights need only what the environments need. Training and trained policies need the extra:
pip install "dq-marine[agents]"; exported policies fly with the extra `deploy` alone.
"""

from dq_marine.util.lazy_names import lazy_attributes, public_names

_names = public_names(__file__)
__all__ = sorted(_names)
__getattr__, __dir__ = lazy_attributes(__name__, _names, globals())
