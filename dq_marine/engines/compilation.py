"""Compilation of kernel functions by Numba, kept on disk until any source they are made of changes."""

from __future__ import annotations

import functools
import hashlib
import importlib
import inspect
import marshal
import os
import pkgutil
import tempfile
from collections.abc import Callable
from pathlib import Path
from types import CodeType, FunctionType, ModuleType
from typing import Any

import numba
import numpy as np
from numba.core.caching import CompileResultCacheImpl, FunctionCache, _CacheLocator
from numba.extending import overload, register_jitable

import dq_marine.engines
import dq_marine.kernel
from dq_marine.announce import announce
from dq_marine.engines.lane_selection import PROVIDED

CONSTANT_TYPES = (bool, int, float, complex, str, tuple, np.ndarray)
"""What compiled code takes as it stood when it was compiled."""

CACHE_DIRECTORY_VARIABLE = "DQ_MARINE_CACHE_DIR"


def cache_directory() -> Path:
    """Return the folder for compiled code: $DQ_MARINE_CACHE_DIR, else the user's cache folder."""
    chosen = os.environ.get(CACHE_DIRECTORY_VARIABLE)
    if chosen:
        return Path(chosen)
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "dq_marine"


def modules_of(package: ModuleType) -> list[ModuleType]:
    """Return a package's modules, imported, in the order of their names."""
    names = sorted(module.name for module in pkgutil.iter_modules(package.__path__))
    return [importlib.import_module(f"{package.__name__}.{name}") for name in names]


def outside_values(function: Callable[..., Any]) -> list[Any]:
    """Return what a function closes over or uses by a name of its module; compiled code takes it as constant."""
    cells = [cell.cell_contents for cell in getattr(function, "__closure__", None) or ()]
    code, names = function.__code__, function.__globals__
    return cells + [names[name] for name in code.co_names if name in names]


def used_functions(function: Callable[..., Any]) -> list[FunctionType]:
    """Return the plain Python functions among a function's outside values."""
    return [value for value in outside_values(function) if inspect.isfunction(value)]


def constants_of(function: Callable[..., Any]) -> str:
    """Return the numbers, texts and arrays among a function's outside values, to tell it from its likes."""
    values = [value for value in outside_values(function) if isinstance(value, CONSTANT_TYPES)]
    return repr([value.tolist() if isinstance(value, np.ndarray) else value for value in values])


def code_of(function: Callable[..., Any]) -> str:
    """Return what tells a function from others of its name in its file: its instructions and their constants."""

    def parts(code: CodeType) -> Any:
        constants = [parts(value) if isinstance(value, CodeType) else repr(value) for value in code.co_consts]
        return code.co_code.hex(), code.co_names, code.co_varnames, constants

    return repr(parts(function.__code__))


def text_of(function: Callable[..., Any]) -> bytes:
    """Return the source file that defines a function, or its code where there is no such file."""
    file = inspect.getsourcefile(function)
    return Path(file).read_bytes() if file and os.path.exists(file) else marshal.dumps(function.__code__)


def all_used_functions(function: Callable[..., Any]) -> list[FunctionType]:
    """Return the plain functions that a function uses, directly or not, each once, in order of appearance."""
    found: dict[FunctionType, None] = {}

    def visit(user: Callable[..., Any]) -> None:
        for used in used_functions(user):
            if used not in found:
                found[used] = None
                visit(used)

    visit(function)
    return list(found)


@functools.cache
def make_compilable(function: FunctionType) -> None:
    """Let compiled code call a plain function, which stays plain Python."""
    if function not in _COMPILED_APART and function not in PROVIDED:
        register_jitable(error_model="numpy", forceinline=True)(function)


@functools.cache
def own_fingerprint() -> bytes:
    """Return a hash over the sources of the kernel and of the engines."""
    digest = hashlib.sha256()
    for package in (dq_marine.kernel, dq_marine.engines):
        for module in modules_of(package):
            digest.update(hashlib.sha256(Path(str(module.__file__)).read_bytes()).digest())
    return digest.digest()


def source_fingerprint(parts: list[Callable[..., Any]]) -> str:
    """Return a hash over the sources of the kernel, of the engines and of the given functions."""
    texts = {hashlib.sha256(text_of(part)).digest() for part in parts}
    return hashlib.sha256(b"".join([own_fingerprint(), *sorted(texts)])).hexdigest()[:20]


def name_of(function: Callable[..., Any]) -> str:
    """Return the dotted name of a function, followed by those of the functions it closes over."""
    cells = [cell.cell_contents for cell in getattr(function, "__closure__", None) or ()]
    inner = ", ".join(name_of(value) for value in cells if inspect.isfunction(value))
    name = f"{function.__module__}.{function.__qualname__}"
    return f"{name}[{inner}]" if inner else name


@functools.cache
def announce_compilation() -> None:
    """Say, once, why a first step takes long."""
    announce("compiling for this scene, some ten seconds; kept for the next time")


class _Locator(_CacheLocator):
    """Places compiled code under `cache_directory()`, in a folder named by the source fingerprint."""

    def __init__(self, folder: Path, fingerprint: str) -> None:
        self._folder = folder
        self._fingerprint = fingerprint

    def get_cache_path(self) -> str:
        return str(self._folder)

    def get_source_stamp(self) -> str:
        return self._fingerprint

    def get_disambiguator(self) -> str:
        return "dq"


class _CompositionCache(FunctionCache):
    """Numba's cache with a key that follows the composition.

    Numba keys a closure on a pickle of its cells, which differs from process to process when a cell holds a
    function; here the functions' names and constants stand for them, and the fingerprint for their text.
    """

    def __init__(self, function: Callable[..., Any], key: str, fingerprint: str) -> None:
        folder = cache_directory() / fingerprint

        class Implementation(CompileResultCacheImpl):
            def __init__(self, py_func: Callable[..., Any]) -> None:
                self._lineno = py_func.__code__.co_firstlineno
                self._locator = _Locator(folder, fingerprint)
                self._filename_base = hashlib.sha256(key.encode()).hexdigest()[:20]

        self._impl_class = Implementation
        self._key = key
        super().__init__(function)

    def _index_key(self, sig: Any, codegen: Any) -> Any:
        return sig, codegen.magic_tuple(), self._key

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        loaded = super().load_overload(sig, target_context)
        if loaded is None:
            announce_compilation()
        return loaded


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
    for part in apart:
        compile_apart(part)
    used = all_used_functions(function)
    for part in used:
        make_compilable(part)
    compiled = numba.njit(error_model="numpy", nogil=True)(function)
    if _writable(cache_directory()):
        parts: list[Callable[..., Any]] = [function, *used]
        key = "|".join([name_of(function), layout, *map(constants_of, parts), *map(code_of, parts)])
        compiled._cache = _CompositionCache(function, key, source_fingerprint(parts))
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


@functools.cache
def _writable(folder: Path) -> bool:
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            return True
    except OSError:
        announce(
            f"{folder} cannot be written, so compiled code is not kept; set {CACHE_DIRECTORY_VARIABLE} to a "
            "folder that can"
        )
        return False
