"""Waiting for a page that is not ready: what it does not have yet is no error, what is mistyped is one."""

from __future__ import annotations

from pathlib import Path

import pytest
from viewer.devtools import open_page

pytestmark = pytest.mark.browser

LATER = "setTimeout(() => document.body.insertAdjacentHTML('beforeend', '<p id=late>here</p>'), 300)"


def test_what_is_not_there_yet_is_waited_for(tmp_path: Path) -> None:
    file = tmp_path / "page.html"
    file.write_text("<p id=begun></p>", encoding="utf-8")
    with open_page(file.as_uri(), ready="document.getElementById('begun') !== null") as page:
        page.evaluate(LATER)
        page.wait_until("document.getElementById('late').innerText === 'here'")
        with pytest.raises(AssertionError, match="ReferenceError"):
            page.wait_until("documnt.body !== null")
