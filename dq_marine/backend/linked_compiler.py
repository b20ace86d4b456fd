"""Numba's compiler without its last step, machine code. It is for functions that only go into others.

What it makes of a function is kept on disk, if the function is registered as a part that scenes share: then a new scene
compiles in a new process in a third of the time.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any

from llvmlite import binding
from numba import types
from numba.core.bytecode import FunctionIdentity
from numba.core.compiler import CompilerBase, CompileResult, compile_result
from numba.core.environment import Environment
from numba.core.untyped_passes import ExtractByteCode

from dq_marine.backend.disk_cache import CompositionCache, Form, open_cache
from dq_marine.backend.fingerprint import key_and_fingerprint
from dq_marine.backend.lane_type import Lanes
from dq_marine.backend.linked_passes import LeanCounts, LinkedLibrary, LinkedPasses, linked_passes, make_known
from dq_marine.backend.parts import PARTS

PLAIN_TYPES = (types.Number, types.Boolean, types.NoneType, types.Array, Lanes)
"""Of arguments, in tuples too, with which a function is kept: not functions, which each process makes anew."""


def is_whole(compiled: CompileResult) -> bool:
    """Whether all that a function calls went into it.

    What did not has a name that Numba counted out in this process, and another process may have given to another.
    """
    library = compiled.library
    library._ensure_finalized()
    names = [function.name for function in library.get_defined_functions()]
    return names == [compiled.fndesc.mangled_name] and not library.has_dynamic_globals


def reduced(compiled: CompileResult) -> tuple[Any, ...]:
    """Return what is kept of a function."""
    described, library = compiled.fndesc, compiled.library
    described.typemap = described.calltypes = None  # as for Numba's own cache: they may not be pickled
    return library.name, library._final_module.as_bitcode(), described, compiled.signature


def rebuilt(target: Any, name: str, bitcode: bytes, described: Any, signature: Any) -> CompileResult:
    """Return the function that was kept, and make it known."""
    library = LinkedLibrary(target.codegen(), name)
    library._final_module = binding.parse_bitcode(bitcode)
    library._finalize_final_module()
    environment = Environment.from_fndesc(described)
    return compile_result(
        typing_context=target.typing_context,
        target_context=target,
        library=library,
        environment=environment,
        entry_point=make_known(target, library, described, environment),
        fndesc=described,
        signature=signature,
        objectmode=False,
        lifted=(),
        reload_init=[],
    )


LINKED = Form(keepable=is_whole, reduce=reduced, rebuild=rebuilt)
"""How such functions are written down."""


@functools.cache
def made_of(function: Callable[..., Any]) -> tuple[str, str]:
    """Return the key and the fingerprint of a part, whatever it is called with."""
    return key_and_fingerprint(function, "part")


def cache_of(function: Callable[..., Any], state: Any) -> CompositionCache | None:
    """Return where a part is kept as it is to be compiled; None if the function is none, or cannot be kept.

    Each signature has files of its own: processes that keep several at once do not meet in one.
    """
    if function not in PARTS or not all(is_plain(kind) for kind in state.args):
        return None
    key, fingerprint = made_of(function)
    return open_cache(function, f"{key}|{state.args}|{state.flags}", fingerprint, LINKED)


def is_plain(kind: types.Type) -> bool:
    """Whether a type means the same in every process."""
    if isinstance(kind, types.BaseTuple):
        if "<locals>" in getattr(kind, "instance_class", tuple).__qualname__:
            return False
        return all(is_plain(part) for part in kind.types)
    return isinstance(kind, PLAIN_TYPES)


class LinkedCompiler(CompilerBase):
    """Numba's compiler, with the passes and the counts of `linked_passes`."""

    def __init__(self, *arguments: Any) -> None:
        super().__init__(*arguments)
        target = self.state.targetctx
        target.nrt = LeanCounts(target, target.enable_nrt)

    def compile_extra(self, function: Callable[..., Any]) -> Any:
        """Load a function from disk, or compile it and keep it there."""
        state, cache = self.state, cache_of(function, self.state)
        if cache is None:
            return super().compile_extra(function)
        found = cache.load_overload(state.args, state.targetctx)
        if found is None:
            found = self._compile_to_be_kept(function, cache.identity)
            cache.save_overload(state.args, found)
        return found

    def _compile_to_be_kept(self, function: Callable[..., Any], identity: str) -> Any:
        """Compile a function by a name that no other has, in no process; Numba's own are counted from 1 in each."""
        named = FunctionIdentity.from_function(function)
        named.unique_id, named.unique_name = identity, f"{named.func_qualname}${identity}"
        self.state.func_id = named
        ExtractByteCode().run_pass(self.state)
        self.state.lifted, self.state.lifted_from = (), None
        return self._compile_bytecode()

    def define_pipelines(self) -> list[LinkedPasses]:
        """Return the one pipeline: there is no Python mode to fall back to."""
        return [linked_passes(self.state.flags)]
