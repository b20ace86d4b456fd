"""Gymnasium environments. Importing `dq_marine` registers them; the public names are imported on first use."""

from dq_marine.util.lazy_names import lazy_attributes, public_names

_names = public_names(__file__)
__all__ = sorted(_names)
__getattr__, __dir__ = lazy_attributes(__name__, _names, globals())
