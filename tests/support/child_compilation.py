"""Compiling in a child process, which takes the compiler's memory with it when it ends.

What Numba compiles it never gives back: some 40 MB for each step that is composed anew, and the tests compose
hundreds. A child finds all that its parent has compiled, adds what is missing to the cache on disk, and ends; the
parent loads it.
"""

from __future__ import annotations

import mmap
import os
import warnings
from pathlib import Path

from llvmlite.binding import ffi
from numba.core.compiler_lock import global_compiler_lock
from numba.core.dispatcher import Dispatcher

PROC = Path("/proc/self/statm")
"""Where Linux says what memory a process holds, in pages. Elsewhere every process compiles for itself."""

ENOUGH = max(1.2e9, os.sysconf("SC_PHYS_PAGES") * mmap.PAGESIZE / 8.0) if PROC.exists() else 1.2e9
"""Bytes from which on a process has others compile. Each of them compiles what this one has not, shared parts too: it
is better to have compiled much, and two processes run the tests."""

HERE = "DQ_MARINE_TESTS_COMPILE_HERE"
"""Variable of the environment: if it is set, no child is asked, so that what was compiled can be looked at."""


def memory_held() -> int:
    """Return the bytes that this process has in memory; 0 where there is no /proc."""
    try:
        return int(PROC.read_text().split()[1]) * mmap.PAGESIZE
    except OSError:
        return 0


def is_kept(dispatcher, signature) -> bool:
    """Whether a function is on disk for a signature, or never will be."""
    cache = dispatcher._cache
    if not hasattr(cache, "_index_key"):
        return True
    try:
        index = cache._cache_file._load_index()
    except Exception:  # damaged, as some tests want it: a pickle of anything fails with anything
        return False
    return cache._index_key(signature, dispatcher.targetctx.codegen()) in index


def forked() -> int:
    """Fork, and return the child's number, or 0 in the child, in which this thread alone goes on.

    LLVM's lock is this thread's meanwhile: if another one held it, nobody would ever release it in the child.
    """
    with warnings.catch_warnings(), ffi.lib._lock:
        warnings.simplefilter("ignore")  # of threads: the child uses none of them
        return os.fork()


def compile_in_children() -> None:
    """Let Numba compile as described, from now on and in this process."""
    compile_here = Dispatcher.compile

    def compile_in_child(dispatcher, signature):
        wanted = HERE not in os.environ and memory_held() > ENOUGH
        with global_compiler_lock:  # other threads wait here, and find what a child has compiled
            if wanted and not is_kept(dispatcher, signature):
                child = forked()
                if child == 0:
                    Dispatcher.compile = compile_here
                    try:
                        compile_here(dispatcher, signature)
                    finally:
                        os._exit(0)  # the parent meets the same error
                os.waitpid(child, 0)
        return compile_here(dispatcher, signature)

    Dispatcher.compile = compile_in_child
