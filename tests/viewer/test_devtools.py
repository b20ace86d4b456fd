"""Waiting for a page that is not ready: what it does not have yet is no error, what is mistyped is one."""

from __future__ import annotations

import pytest
from viewer.devtools import open_page

pytestmark = pytest.mark.browser

LATER = "setTimeout(() => document.body.insertAdjacentHTML('beforeend', '<p id=late>here</p>'), 300)"


def test_what_is_not_there_yet_is_waited_for() -> None:
    with open_page("data:text/html,<body></body>", ready="document.body !== null") as page:
        page.evaluate(LATER)
        page.wait_until("document.getElementById('late').innerText === 'here'")
        with pytest.raises(AssertionError, match="ReferenceError"):
            page.wait_until("documnt.body !== null")
