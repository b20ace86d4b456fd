"""Reading a table of depths from a NumPy file."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from dq_marine.checks import real_numbers
from dq_marine.errors import InvalidInputError


def read_npy(path: Path) -> NDArray[np.float64]:
    """Return the numbers of a NumPy file (.npy) as float64, of whatever shape; objects are not unpickled.

    Raises:
        InvalidInputError: it cannot be read, is no such file, or has something that is no real number.
    """
    try:
        with path.open("rb") as file:
            found = np.lib.format.read_array(file, allow_pickle=False)
    except Exception as error:  # what a damaged header leads to is not listed anywhere
        raise InvalidInputError(
            f"{path} is no NumPy file of numbers: {error}; write one by numpy.save(file, depths)"
        ) from error
    return real_numbers(path.name, found, "a table of depths")
