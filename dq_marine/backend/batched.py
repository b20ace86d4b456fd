"""Pure functions on arrays.

A pure function made of sums and products alone (products, conjugates, rotations, frame changes) takes tuples
whose components are NumPy arrays as it is: the components broadcast. A function that branches or calls `math`
(exponential, logarithm, screws, `sclerp`) does not; `batched` makes it one that does:

    batched(pose_log)(poses)                   `poses` a DualQuaternion of components of shape (n,), say
    batched(sclerp)(start, end, fractions)     two single poses and an array of fractions
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any

import numpy as np
from numba import types

from dq_marine.algebra.nesting import numbers_of, rebuild
from dq_marine.backend.compilation import compile_function
from dq_marine.backend.packing import make_load, pack, store, structure_type, unpack


def batched(function: Callable[..., Any]) -> Callable[..., Any]:
    """Return a pure function that takes and returns (nested tuples of) arrays.

    The components of all arguments broadcast together, as float64, and every component of the result has the
    common shape. Each entry has the bits of a call with that entry's numbers. Compiled at the first call with a
    new nesting of arguments, and kept on disk.

    Args:
        function: of positional arguments, each a number or nested tuples of numbers. It must not raise.
    """

    @functools.wraps(function)
    def on_arrays(*arguments: Any) -> Any:
        components = np.broadcast_arrays(*(np.asarray(c, dtype=np.float64) for c in numbers_of(arguments)))
        shape = components[0].shape
        numbers = np.stack([component.ravel() for component in components], axis=1)
        # One call in plain Python tells how the result is nested, of zeros if there is no entry to try.
        sample = unpack(arguments, numbers[0] if len(numbers) else np.zeros(len(components)))
        result = function(*sample)
        results = np.empty((len(numbers), len(pack(result))))
        _compiled(function, structure_type(sample))(numbers, results)
        return rebuild(result, iter([np.reshape(column, shape) for column in results.T]))

    return on_arrays


@functools.cache
def _compiled(function: Callable[..., Any], layout: types.Type) -> Callable[..., Any]:
    """Compile (numbers, results): the function of every row of `numbers`, into the rows of `results`."""
    load = make_load(layout)

    def apply_to_rows(numbers: Any, results: Any) -> None:
        for row in range(numbers.shape[0]):
            store(results[row], function(*load(numbers[row])))

    return compile_function(apply_to_rows, str(layout))
