"""Numba's compiler without its last step, machine code. It is for functions that only go into others."""

from __future__ import annotations

from typing import Any

from numba import _dynfunc
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompilerBase, DefaultPassBuilder
from numba.core.compiler_machinery import register_pass
from numba.core.typed_passes import NativeLowering


class LinkedLibrary(JITCodeLibrary):
    """LLVM's text of a function and of all that it calls, optimised, to be linked into that of its callers."""

    def _finalize_final_module(self) -> None:
        self._finalize_dynamic_globals()
        self._verify_declare_only_symbols()
        self._finalized = True


@register_pass(mutates_CFG=True, analysis_only=False)
class LinkedLowering(NativeLowering):
    """Numba's lowering, without machine code."""

    _name = "linked_lowering"

    def run_pass(self, state: Any) -> bool:
        """Lower a function, and let its callers find it by a handle that cannot be called from Python."""
        name = state.func_id.func_qualname
        state.library = LinkedLibrary(state.targetctx.codegen(), name)
        state.flags.no_compile = True
        super().run_pass(state)
        lowered = state["cr"]
        module, kept_alive = lowered.fndesc.lookup_module(), (state.library,)
        handle = _dynfunc.make_function(module, name, "", 0, lowered.env, kept_alive)
        state.targetctx.insert_user_function(handle, lowered.fndesc, [state.library])
        state["cr"] = lowered._replace(cfunc=handle)
        return True


class LinkedCompiler(CompilerBase):
    """Numba's compiler, with that lowering."""

    def define_pipelines(self) -> list[Any]:
        """Return the one pipeline: there is no Python mode to fall back to."""
        pipeline = DefaultPassBuilder.define_nopython_pipeline(self.state, "linked")
        pipeline.passes = [
            (LinkedLowering if step is NativeLowering else step, description)
            for step, description in pipeline.passes
        ]
        pipeline.finalize()
        return [pipeline]
