"""Compilation of pure functions by Numba, kept on disk until any source they are made of changes."""

from __future__ import annotations

import functools
from collections.abc import Callable
from types import FunctionType
from typing import Any

import numba
from numba.extending import overload, register_jitable

from dq_marine.backend import entries, stages, structure_sums, wide_words  # noqa: F401  give compiled code what they provide
from dq_marine.backend.disk_cache import keep_on_disk
from dq_marine.backend.fingerprint import all_used_functions, key_and_fingerprint
from dq_marine.backend.inlining import INLINED
from dq_marine.backend.parts import PARTS
from dq_marine.backend.selection import PROVIDED
from dq_marine.backend.while_compiling import watch_compilations


@functools.cache
def make_compilable(function: FunctionType) -> None:
    """Let compiled code call a plain function, which stays plain Python."""
    if function not in _COMPILED_APART and function not in PROVIDED:
        register_jitable(**INLINED)(function)
        PARTS.add(function)


def compile_function(
    function: Callable[..., Any], layout: str, apart: tuple[Callable[..., Any], ...] = ()
) -> Callable[..., Any]:
    """Compile a function and the plain functions it uses, for any signature it is then called with.

    Functions are found by the names they are called by: import them by name, not through their module.

    Args:
        function: what to compile.
        layout: whatever distinguishes it beyond the functions it closes over, such as the types it loads.
        apart: functions it uses that are rarely called: compiled by themselves, once for all that use them,
            instead of into each.

    Returns:
        The compiled function; it is loaded from disk if sources, Numba and processor are those of the last
        time.
    """
    watch_compilations()
    for part in apart:
        compile_apart(part)
    for part in all_used_functions(function):
        make_compilable(part)
    compiled = numba.njit(error_model="numpy", nogil=True, no_cfunc_wrapper=True)(function)
    keep_on_disk(compiled, function, *key_and_fingerprint(function, layout))
    return compiled


@functools.cache
def compile_apart(function: Callable[..., Any]) -> None:
    """Let compiled code call a plain function as a compiled function of its own."""
    compiled = compile_function(function, "apart")

    @overload(function, strict=False)
    def call_compiled(*arguments: Any) -> Any:
        def call(*arguments: Any) -> Any:
            return compiled(*arguments)

        return call

    _COMPILED_APART.add(function)


_COMPILED_APART: set[Callable[..., Any]] = set()
"""Functions that `make_compilable` must leave alone."""
