"""How functions that go into others are compiled: no further than LLVM's text, for machine code is made of the whole.

Numba makes machine code of every function that it compiles, of those too that are only ever inlined. A step is some
hundred of them, one within another, so that the innermost would become machine code a dozen times over. Without that a
step for one body compiles in two thirds of the time and one in lanes in half of it, and its instructions are the same.

`pipeline_class` is what Numba has for compilers of one's own. What stands behind it may change from version to version,
so it is used with those that it was tried with; others compile as they always did.
"""

from __future__ import annotations

from typing import Any

import numba

TRIED_VERSIONS = {(0, 68)}
"""Versions of Numba with which tests/backend/test_inlining.py passed."""


def inlining_options(version: tuple[int, int]) -> dict[str, Any]:
    """Return the options with which a version of Numba compiles functions that go into others.

    Nothing calls them from C: a wrapper for that, which Numba makes unless told otherwise, would cost a tenth of the
    time that compilation takes.
    """
    options: dict[str, Any] = {"error_model": "numpy", "forceinline": True, "no_cfunc_wrapper": True}
    if version not in TRIED_VERSIONS:
        return options
    from dq_marine.backend.linked_compiler import (
        LinkedCompiler,
    )  # here: other versions may not have what it imports

    return options | {"pipeline_class": LinkedCompiler}


INLINED = inlining_options(numba.version_info.short)
"""Numba's options for functions that go into others."""
