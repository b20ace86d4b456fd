"""How the tests run: the compiler's memory is given back."""

from __future__ import annotations

from support.child_compilation import compile_in_children


def pytest_configure() -> None:
    """Bound the memory of long runs."""
    compile_in_children()
