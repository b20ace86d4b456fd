"""Compilation of kernel functions by Numba, kept on disk until any source they are made of changes."""

from __future__ import annotations

import functools
import hashlib
import importlib
import inspect
import os
import pkgutil
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from types import FunctionType, ModuleType
from typing import Any

import numba
from numba.core.caching import CompileResultCacheImpl, FunctionCache, _CacheLocator
from numba.extending import register_jitable

import dq_marine.engines
import dq_marine.kernel

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


def functions_of(module: ModuleType) -> list[FunctionType]:
    """Return the plain functions that a module defines."""
    return [
        value
        for value in vars(module).values()
        if inspect.isfunction(value) and value.__module__ == module.__name__
    ]


@functools.cache
def make_compilable(function: Callable[..., Any]) -> None:
    """Let compiled code call a plain function and the functions it closes over."""
    register_jitable(error_model="numpy", forceinline=True)(function)
    for inner in closed_over(function):
        make_compilable(inner)


def closed_over(function: Callable[..., Any]) -> list[FunctionType]:
    """Return the plain functions in a function's closure."""
    cells = getattr(function, "__closure__", None) or ()
    return [cell.cell_contents for cell in cells if inspect.isfunction(cell.cell_contents)]


@functools.cache
def register_kernel() -> None:
    """Let compiled code call every function of the kernel."""
    for module in modules_of(dq_marine.kernel):
        for function in functions_of(module):
            make_compilable(function)


@functools.cache
def source_fingerprint(files: frozenset[str]) -> str:
    """Return a hash over the sources of the kernel, of the engines and of the given files."""
    own = {
        str(module.__file__)
        for package in (dq_marine.kernel, dq_marine.engines)
        for module in modules_of(package)
    }
    digest = hashlib.sha256()
    for file in sorted(own | files):
        content = Path(file).read_bytes() if os.path.exists(file) else file.encode()
        digest.update(hashlib.sha256(content).digest())
    return digest.hexdigest()[:20]


def name_of(function: Callable[..., Any]) -> str:
    """Return the dotted name of a function, followed by those of the functions it closes over."""
    inner = closed_over(function)
    name = f"{function.__module__}.{function.__qualname__}"
    return f"{name}[{', '.join(map(name_of, inner))}]" if inner else name


def sources_of(function: Callable[..., Any]) -> set[str]:
    """Return the source files of a function and of the functions it closes over."""
    files = {inspect.getsourcefile(function) or name_of(function)}
    return files.union(*map(sources_of, closed_over(function)))


class _Locator(_CacheLocator):  # type: ignore[misc]
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


class _CompositionCache(FunctionCache):  # type: ignore[misc]
    """Numba's cache with a key that follows the composition.

    Numba keys a closure on a pickle of its cells, which differs from process to process when a cell holds a
    function; here the functions' names stand for them, and the fingerprint for their text.
    """

    def __init__(self, function: Callable[..., Any], key: str, fingerprint: str) -> None:
        folder = cache_directory() / fingerprint

        class Implementation(CompileResultCacheImpl):  # type: ignore[misc]
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
            announce("compiling for this scene: about ten seconds, once on this machine")
        return loaded


def announce(message: str) -> None:
    """Tell the person at the terminal why they wait."""
    sys.stderr.write(f"dq-marine: {message}\n")
    sys.stderr.flush()


def compile_function(function: Callable[..., Any], layout: str) -> Callable[..., Any]:
    """Compile a function that closes over plain functions, for any signature it is then called with.

    Args:
        function: what to compile.
        layout: whatever distinguishes it beyond the functions it closes over, such as the types it loads.

    Returns:
        The compiled function; it is loaded from disk if sources, Numba and processor are those of the last
        time.
    """
    register_kernel()
    for inner in closed_over(function):
        make_compilable(inner)
    compiled = numba.njit(error_model="numpy", nogil=True)(function)
    if _writable(cache_directory()):
        fingerprint = source_fingerprint(frozenset(sources_of(function)))
        compiled._cache = _CompositionCache(function, f"{name_of(function)}|{layout}", fingerprint)
    return compiled  # type: ignore[no-any-return]


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
