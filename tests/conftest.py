"""How the tests run: the compiler's memory is given back; `support` says what is left out and what is measured."""

from __future__ import annotations

from support.child_compilation import compile_in_children

pytest_plugins = ("support.browser", "support.sweeps", "support.compilations")


def pytest_configure() -> None:
    """Bound the memory of long runs."""
    compile_in_children()
