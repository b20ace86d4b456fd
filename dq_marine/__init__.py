"""Gymnasium environments for marine vehicles, on a dual quaternion variational integrator.

Importing this package registers the environments with Gymnasium and nothing else: Numba, torch and meshcat are
imported when something is stepped, trained or drawn.
"""

from dq_marine.envs.registration import register_environments

__all__ = ["__version__"]

__version__ = "0.1.0"

register_environments()
