"""The code on the pages of the documentation runs, and what they name exists."""

from __future__ import annotations

import os
import re
import shlex
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import click
import pytest
import typer
from support.site_pages import DOCS, PAGES, ROOT, WITH_CODE, Page
from support.sweeps import sweep

from dq_marine import viewer
from dq_marine.cli.main import app
from dq_marine.envs import load_scenario, registered_tasks

NAMES = [page.name for page in WITH_CODE]
PLAIN = ["concepts/units.md", "index.md"]


@pytest.mark.parametrize("name", sweep(NAMES, plain=PLAIN))
def test_the_code_of_a_page_runs(name: str, tmp_path: Path) -> None:
    """Its blocks in their order, as one program, in an empty folder."""
    page = next(page for page in WITH_CODE if page.name == name)
    missing = [module for module in page.needs if not find_spec(module)]
    if missing:
        pytest.skip(f"needs {', '.join(missing)}")
    (tmp_path / "page.py").write_text(page.program, encoding="utf-8")
    strict = [] if page.needs else ["-W", "error"]  # what other libraries warn of is not ours
    result = subprocess.run(
        [sys.executable, *strict, "page.py"],
        capture_output=True,
        text=True,
        cwd=tmp_path,
        env=os.environ | {"MINARI_DATASETS_PATH": str(tmp_path / "datasets"), "JAX_PLATFORMS": "cpu"},
        timeout=1800,
    )
    assert result.returncode == 0, result.stderr


@pytest.mark.parametrize("page", WITH_CODE, ids=lambda page: page.name)
def test_code_that_is_not_run_says_so(page: Page) -> None:
    """Only what cannot be installed beside the pins is left out, and its page says why."""
    compile(page.program, page.name, "exec")
    if set(page.needs) & {"ray"}:
        assert "CI does not run this page" in page.text


def test_shown_files_are_examples() -> None:
    """tests/test_examples.py runs those."""
    shown = [name for page in PAGES for name in page.snippets]
    assert shown
    assert [
        name for name in shown if not re.fullmatch(r"examples/\w+\.py", name) or not (ROOT / name).exists()
    ] == []


COMMANDS = sorted({command for page in PAGES for command in page.commands})


@pytest.mark.parametrize("command", COMMANDS)
def test_the_program_has_the_command_and_its_options(command: str) -> None:
    group, words = typer.main.get_command(app), shlex.split(command)[1:]
    context = click.Context(group)
    while isinstance(group, click.Group):
        name, group, words = group.resolve_command(context, words)
        assert group is not None, f"there is no command {name}"
    group.make_context(command, words)
    if "--scenario" in words and "/" in (scenario := words[words.index("--scenario") + 1]):
        load_scenario(scenario)


def test_tasks_that_are_named_exist() -> None:
    known = {task.id for task in registered_tasks()}
    named = {(page.name, name) for page in PAGES for name in re.findall(r"dq_marine/\w+-v\d+", page.text)}
    assert sorted((page, name) for page, name in named if name not in known) == []


def test_each_public_name_stands_on_a_page_of_the_api() -> None:
    described = set()
    for path in (DOCS / "api").glob("*.md"):
        described |= set(re.findall(r"^::: dq_marine\.(?:\w+\.)?(\w+)$", path.read_text(), re.MULTILINE))
    public = set(viewer.__all__)
    for stub in ("dq_marine", "envs", "agents"):
        public |= set(re.findall(r"import \w+ as (\w+)", (ROOT / stub / "__init__.pyi").read_text()))
    assert public == described


def test_the_picture_of_the_frames_can_be_drawn_again(tmp_path: Path) -> None:
    picture = tmp_path / "frames.png"
    subprocess.run([sys.executable, str(DOCS / "site/draw_frames.py"), str(picture)], check=True, timeout=600)
    assert picture.stat().st_size > 10_000
