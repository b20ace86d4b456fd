"""Words to the person at the terminal, apart from a program's own output."""

from __future__ import annotations

import sys


def announce(message: str) -> None:
    """Say what is going on, on standard error."""
    sys.stderr.write(f"dq-marine: {message}\n")
    sys.stderr.flush()
