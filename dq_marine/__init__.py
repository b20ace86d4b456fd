"""Gymnasium environments for marine vehicles, on a dual quaternion variational integrator.

Importing this package registers the environments with Gymnasium and nothing else. The public names stand in
`__init__.pyi`, one line each, and are imported when they are first used: Numba is imported when something is
stepped, torch when something is trained, meshcat when something is drawn.
"""

from dq_marine.envs.registration import register_environments
from dq_marine.util.lazy_names import lazy_attributes, public_names

__version__ = "0.1.0"

_names = public_names(__file__)
__all__ = ["__version__", *sorted(_names)]
__getattr__, __dir__ = lazy_attributes(__name__, _names, globals())

register_environments()
