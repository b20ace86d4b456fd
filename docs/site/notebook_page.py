"""A notebook as a page: its text and its code, without outputs."""

from __future__ import annotations

import json


def page_of_notebook(notebook: str) -> str:
    """Return the cells of a notebook, given as JSON, as Markdown."""
    parts = []
    for cell in json.loads(notebook)["cells"]:
        text = "".join(cell["source"]).strip()
        if text:
            parts.append(f"```python\n{text}\n```" if cell["cell_type"] == "code" else text)
    return "\n\n".join(parts) + "\n"
