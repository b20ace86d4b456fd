"""How the tests run: the compiler's memory is given back, and those that open a browser go one after another."""

from __future__ import annotations

import pytest
from support.child_compilation import compile_in_children


def pytest_configure() -> None:
    """Bound the memory of long runs."""
    compile_in_children()


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Name each test's group for pytest-xdist: the browser's, or its file's."""
    for item in items:
        group = "browser" if item.get_closest_marker("browser") else item.path.stem
        item.add_marker(pytest.mark.xdist_group(group))
