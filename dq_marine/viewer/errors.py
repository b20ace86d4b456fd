"""The exception of the viewer's processes; bad input raises the exceptions of `dq_marine.errors`."""

from __future__ import annotations

from dq_marine.errors import DQMarineError


class ViewerError(DQMarineError, RuntimeError):
    """The viewer's server or browser did not do what was asked; the message says what to do."""
