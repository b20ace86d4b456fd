"""The parts of Numba's compiler that `linked_compiler` puts in place of Numba's own.

Each leaves out what functions that only go into others do not need. What is computed stays the same, and so do the
instructions that the whole becomes.
"""

from __future__ import annotations

import functools
from types import SimpleNamespace
from typing import Any

from numba import _dynfunc, types
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import DefaultPassBuilder, Flags
from numba.core.compiler_machinery import PassManager, register_pass
from numba.core.errors import new_error_context  # type: ignore[attr-defined]
from numba.core.runtime.context import NRTContext
from numba.core.typed_passes import NativeLowering, NopythonRewrites


class LinkedLibrary(JITCodeLibrary):
    """LLVM's text of a function and of all that it calls, optimised, to be linked into that of its callers."""

    def _optimize_functions(self, module: Any) -> None:
        """Optimise what a function's text defines. Numba goes over what it only declares, too."""
        module.data_layout = self._codegen._data_layout
        for function in module.functions:
            if not function.is_declaration:
                passes, builder = self._codegen._function_pass_manager()
                passes.run(function, builder)

    def _finalize_final_module(self) -> None:
        self._finalize_dynamic_globals()
        self._verify_declare_only_symbols()
        self._finalized = True


@functools.cache
def owns_memory(model: Any) -> bool:
    """Whether there is anything in values of a kind, of which Numba counts how many refer to it: an array's memory."""
    return bool(model.contains_nrt_meminfo())


class LeanCounts(NRTContext):
    """Counts references as Numba does, but does not search structures that hold no memory.

    Whenever a structure is passed on, Numba itself writes text that takes out every number, which LLVM removes again:
    two fifths of the instructions that an environment's step is written in.
    """

    def get_meminfos(self, builder: Any, kind: Any, value: Any) -> list[Any]:
        """Return what is counted of a value."""
        if not owns_memory(self._context.data_model_manager[kind]):
            return []
        return list(super().get_meminfos(builder, kind, value))


def make_known(target: Any, library: LinkedLibrary, described: Any, environment: Any) -> Any:
    """Let callers find a function, and return the handle by which they do. It cannot be called from Python."""
    module, name = described.lookup_module(), described.qualname
    handle = _dynfunc.make_function(module, name, "", 0, environment, (library,))
    target.insert_user_function(handle, described, [library])
    return handle


@register_pass(mutates_CFG=True, analysis_only=False)
class LinkedLowering(NativeLowering):
    """Numba's lowering, without machine code."""

    _name = "linked_lowering"

    def run_pass(self, state: Any) -> bool:
        """Lower a function, and make it known."""
        state.library = LinkedLibrary(state.targetctx.codegen(), state.func_id.func_qualname)
        state.flags.no_compile = True
        super().run_pass(state)
        lowered = state["cr"]
        handle = make_known(state.targetctx, state.library, lowered.fndesc, lowered.env)
        state["cr"] = lowered._replace(cfunc=handle)
        return True


@register_pass(mutates_CFG=True, analysis_only=False)
class ArrayRewrites(NopythonRewrites):
    """Numba's joining of operations on arrays, for functions with arrays: others have nothing to join."""

    _name = "array_rewrites"

    def run_pass(self, state: Any) -> bool:
        """Join them."""
        if any(isinstance(kind, types.Array) for kind in state.typemap.values()):
            return bool(super().run_pass(state))
        return False


IN_PLACE_OF = {NativeLowering: LinkedLowering, NopythonRewrites: ArrayRewrites}
"""Numba's passes for which others stand."""


class LinkedPasses(PassManager):
    """Passes that run one after another, without clocks, and without the checks that are meant for their authors."""

    def _runPass(self, index: int, one: Any, state: Any) -> None:  # noqa: N802 - Numba's name
        one.analysis = self._analysis
        with new_error_context("Pass {name}", name=one.name()):
            one.run_initialization(state)
            one.run_pass(state)
            one.run_finalizer(state)


@functools.cache
def linked_passes(flags: Flags) -> LinkedPasses:
    """Return Numba's passes from bytecode to text, with ours in their places; one object for all functions."""
    passes = LinkedPasses("linked")
    before_any = SimpleNamespace(func_ir=None, flags=flags)
    for step, description in DefaultPassBuilder.define_nopython_pipeline(before_any).passes:
        passes.add_pass(IN_PLACE_OF.get(step, step), description)
    passes.finalize()
    return passes
