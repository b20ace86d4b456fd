"""Whether two results of environments are the same to the last bit."""

from __future__ import annotations

from typing import Any

import numpy as np
from gymnasium.utils.env_checker import data_equivalence


def same(one: Any, other: Any) -> bool:
    """Return whether two results are equal, in type and every bit; a number may be an array without dimensions."""
    return bool(data_equivalence(_bare(one), _bare(other), exact=True))


def _bare(value: Any) -> Any:
    if isinstance(value, dict):
        return {name: _bare(part) for name, part in value.items()}
    if isinstance(value, list | tuple):
        return type(value)(_bare(part) for part in value)
    return value[()] if isinstance(value, np.ndarray) and value.ndim == 0 else value
