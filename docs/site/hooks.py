"""What MkDocs adds to the pages of `docs`: pages made of README and of the notebook, and the replays that are shown.

MkDocs finds the functions by their names (https://www.mkdocs.org/dev-guide/plugins/#events).
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from functools import partial
from pathlib import Path

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files
from notebook_page import page_of_notebook
from readme_pages import PAGES, page_of_sections
from replays import comparisons_in, shown_in, write_comparison, write_replay

ROOT = Path(__file__).parents[2]
LINKS_TO_README = {"../README.md#settings": "settings.md"}
"""Links that lead out of `docs`, and the pages of the site that stand for what they lead to."""


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add the pages that are made, and a replay for each that a page shows."""
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    for name, page in PAGES.items():
        files.append(File.generated(config, name, content=page_of_sections(readme, page)))
    notebook = (ROOT / "examples/first_steps.ipynb").read_text(encoding="utf-8")
    files.append(File.generated(config, "tutorials/first_steps.md", content=page_of_notebook(notebook)))
    pages = [file.content_string for file in files.documentation_pages()]
    for scenario in sorted({scenario for page in pages for scenario in shown_in(page)}):
        content = _written(partial(write_replay, scenario))
        files.append(File.generated(config, f"replays/{scenario}.html", content=content))
    compared = {name: options for page in pages for name, options in comparisons_in(page).items()}
    for name, options in compared.items():
        content = _written(partial(write_comparison, options))
        files.append(File.generated(config, f"comparisons/{name}.html", content=content))
    return files


def on_page_markdown(markdown: str, **_: object) -> str:
    """Lead links to README to the pages made of it."""
    for link, page in LINKS_TO_README.items():
        markdown = markdown.replace(f"]({link})", f"]({page})")
    return markdown


def _written(write: Callable[[Path], None]) -> str:
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "replay.html"
        write(file)
        return file.read_text(encoding="utf-8")
