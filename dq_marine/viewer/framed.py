"""Pages inside another page, such as a notebook."""

from __future__ import annotations

import html

STYLE = "width: 100%; aspect-ratio: 4 / 3; max-height: 90vh; border: 0"


def framed(page: str) -> str:
    """Return HTML that shows a whole page, which comes along with it, in a frame of its own."""
    return f'<iframe title="dq-marine" style="{STYLE}" srcdoc="{html.escape(page)}"></iframe>'


def framed_address(url: str) -> str:
    """Return HTML that shows the page at an address in a frame."""
    return f'<iframe title="dq-marine" style="{STYLE}" src="{html.escape(url)}"></iframe>'
