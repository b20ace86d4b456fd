"""Numbers as a vehicle file shows them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np


def rounded(value: Any) -> Any:
    """Return numbers, in arrays, lists and tables too, to nine digits, more than any of them means; arrays as lists."""
    if isinstance(value, np.ndarray | np.generic):
        return rounded(value.tolist())
    if isinstance(value, Mapping):
        return {key: rounded(part) for key, part in value.items()}
    if isinstance(value, list | tuple):
        return [rounded(part) for part in value]
    return float(f"{value:.9g}") + 0.0 if isinstance(value, float) else value  # + 0.0: no minus before a zero
