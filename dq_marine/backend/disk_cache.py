"""Compiled code on disk. Numba keeps and finds it; here is where, by which key, and what happens if that fails.

What Numba documents of its cache is `jit(cache=True)` alone, which cannot key a closure by what it is made of. So its
classes are used here, and nothing of theirs may stand in the way of compiling: whatever goes wrong in loading or
keeping is said once, and the function is compiled and runs.
"""

from __future__ import annotations

import contextlib
import functools
import hashlib
import os
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

from numba.core.caching import CompileResultCacheImpl, FunctionCache, _CacheLocator
from numba.core.compiler import CompileResult

from dq_marine.errors import InvalidInputError
from dq_marine.util.announce import announce

CACHE_DIRECTORY_VARIABLE = "DQ_MARINE_CACHE_DIR"


def cache_directory() -> Path:
    """Return the folder for compiled code: $DQ_MARINE_CACHE_DIR, else the user's cache folder.

    Raises:
        InvalidInputError: the variable is not set, and the user has no home.
    """
    chosen = os.environ.get(CACHE_DIRECTORY_VARIABLE)
    if chosen:
        return Path(chosen)
    try:
        return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "dq_marine"
    except RuntimeError as error:
        raise InvalidInputError(
            f"there is no home to keep compiled code in; set {CACHE_DIRECTORY_VARIABLE} to a folder of yours"
        ) from error


class Form(NamedTuple):
    """How compiled code is written down.

    Attributes:
        keepable: (what was compiled) -> whether another process can load it.
        reduce: (what was compiled) -> what is pickled.
        rebuild: (Numba's target, *what was pickled) -> what was compiled.
    """

    keepable: Callable[[CompileResult], bool]
    reduce: Callable[[CompileResult], tuple[Any, ...]]
    rebuild: Callable[..., CompileResult]


def has_no_addresses(compiled: CompileResult) -> bool:
    """Whether machine code can be loaded by another process. Numba's own check warns of a file that we have not."""
    if compiled.library.has_dynamic_globals:
        _announce_failure("kept", "it holds addresses of this process, as with NUMBA_OPT=0")
        return False
    return True


MACHINE_CODE = Form(has_no_addresses, CompileResult._reduce, CompileResult._rebuild)
"""Numba's own form."""


def keep_on_disk(compiled: Any, function: Callable[..., Any], key: str, fingerprint: str) -> None:
    """Let a dispatcher of Numba's load its code from disk, and keep there what it compiles.

    Args:
        compiled: the dispatcher.
        function: what it compiles.
        key: tells the function from all others of the same sources.
        fingerprint: of the sources.
    """
    cache = open_cache(function, key, fingerprint)
    if cache is not None:
        compiled._cache = cache


def open_cache(
    function: Callable[..., Any], key: str, fingerprint: str, form: Form = MACHINE_CODE
) -> CompositionCache | None:
    """Return where a function's compiled code is kept on disk; None where it cannot be.

    Args:
        function: what is compiled.
        key: tells the function from all others of the same sources.
        fingerprint: of the sources.
        form: in which it is kept.
    """
    try:
        folder = cache_directory()
    except InvalidInputError as error:
        _announce_homeless(str(error))
        return None
    if not _writable(folder):
        return None
    try:
        return CompositionCache(function, key, fingerprint, form)
    except Exception as error:  # Numba's own, of a version that is made otherwise
        _announce_failure("kept", _reason(error))
        return None


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


class CompositionCache(FunctionCache):
    """Numba's cache with a key that follows the composition.

    Numba keys a closure on a pickle of its cells, which differs from process to process when a cell holds a
    function; here the functions' names and constants stand for them, and the fingerprint for their text.
    """

    def __init__(
        self, function: Callable[..., Any], key: str, fingerprint: str, form: Form = MACHINE_CODE
    ) -> None:
        folder = cache_directory() / fingerprint
        base = hashlib.sha256(key.encode()).hexdigest()[:20]

        class Implementation(CompileResultCacheImpl):
            def __init__(self, py_func: Callable[..., Any]) -> None:
                self._lineno = py_func.__code__.co_firstlineno
                self._locator = _Locator(folder, fingerprint)
                self._filename_base = base

            def check_cachable(self, cres: CompileResult) -> bool:
                return form.keepable(cres)

            def reduce(self, cres: CompileResult) -> tuple[Any, ...]:
                return form.reduce(cres)

            def rebuild(self, target_context: Any, payload: tuple[Any, ...]) -> CompileResult:
                return form.rebuild(target_context, *payload)

        self._impl_class = Implementation
        self.identity = hashlib.sha256(f"{fingerprint}|{key}".encode()).hexdigest()[:16]
        self._key = key
        self._files = folder, base
        super().__init__(function)

    def _index_key(self, sig: Any, codegen: Any) -> Any:
        return sig, codegen.magic_tuple(), self._key

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """Return what is on disk for a signature, None if nothing is that can be loaded."""
        try:
            loaded = super().load_overload(sig, target_context)
        except Exception as error:  # a pickle of anything fails with anything
            _announce_failure("loaded", _reason(error))
            self._drop()
            loaded = None
        if loaded is None:
            announce_compilation()
        return loaded

    def save_overload(self, sig: Any, data: Any) -> None:
        """Keep what was compiled for a signature, if that can be done."""
        try:
            super().save_overload(sig, data)
        except Exception as error:  # no space is left, or something that no pickle takes
            _announce_failure("kept", _reason(error))

    def _drop(self) -> None:
        """Remove the function's files, so that they are written anew."""
        folder, base = self._files
        for path in folder.glob(f"{base}.*"):
            with contextlib.suppress(OSError):
                path.unlink()


@functools.cache
def announce_compilation() -> None:
    """Say, once, why a first step takes long."""
    announce("compiling for this scene, some ten seconds; kept for the next time")


@functools.cache
def _announce_failure(what: str, reason: str) -> None:
    """Say, once for each reason, that compiled code could not be loaded or kept."""
    announce(f"compiled code cannot be {what} in {cache_directory()}: {reason}; compiling goes on")


@functools.cache
def _announce_homeless(reason: str) -> None:
    """Say, once, that there is no folder to keep compiled code in."""
    announce(reason)


def _reason(error: Exception) -> str:
    return f"{type(error).__name__}: {error}"


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
