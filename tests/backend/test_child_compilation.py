"""The tests' own compiling in children: a child can always go on, whatever other threads were doing."""

from __future__ import annotations

import os
import threading
import time

import pytest
from llvmlite import binding
from support import child_compilation


@pytest.mark.skipif(not hasattr(os, "fork"), reason="this system has no fork")
def test_a_child_never_waits_for_a_lock_of_a_thread_that_it_does_not_have() -> None:
    done = threading.Event()

    def ask_llvm_all_the_time() -> None:
        while not done.is_set():
            binding.get_process_triple()

    other = threading.Thread(target=ask_llvm_all_the_time)
    other.start()
    try:
        for _ in range(30):
            child = child_compilation.forked()
            if child == 0:
                binding.get_process_triple()
                os._exit(0)
            assert ended(child)
    finally:
        done.set()
        other.join()


def ended(child: int, patience: float = 60.0) -> bool:
    """Wait for a child; kill it if it does not end."""
    deadline = time.monotonic() + patience
    while time.monotonic() < deadline:
        if os.waitpid(child, os.WNOHANG) != (0, 0):
            return True
        time.sleep(0.002)
    os.kill(child, 9)
    os.waitpid(child, 0)
    return False
