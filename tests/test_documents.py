"""The documents speak of what is there: their links, paths and dotted names exist, and no folder is left out."""

import ast
import importlib
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
DOCUMENTS = [
    ROOT / name
    for name in ("README.md", "CONTRIBUTING.md", "docs/architecture.md", "docs/theory.md", "docs/tracking.md")
]
BASES = (ROOT, ROOT / "dq_marine", ROOT / "docs", ROOT / "tests")
MADE_BY_COMMANDS = ("demo/", "runs/")
SUBPACKAGES = "|".join(sorted(path.name for path in (ROOT / "dq_marine").iterdir() if path.is_dir()))


def code_spans(path):
    text = re.sub(r"```.*?```", "", path.read_text(), flags=re.DOTALL)
    return set(re.findall(r"`([^`\n]+)`", text))


def exists(name):
    """Whether a file is at this path, or a folder is at it or below one that its sentence names."""
    if any((base / name).exists() for base in BASES):
        return True
    return name.endswith("/") and any(
        path.is_dir() for top in ("dq_marine", "envs", "agents") for path in (ROOT / top).rglob(name)
    )


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: path.name)
def test_links_lead_to_files(document):
    targets = re.findall(r"\]\(([^)#]+?)(?:#[^)]*)?\)", document.read_text())
    local = [target for target in targets if not target.startswith("http")]
    assert local or document.name == "theory.md"
    assert [target for target in local if not (document.parent / target).exists()] == []


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: path.name)
def test_paths_exist(document):
    spans = {span.split("::")[0] for span in code_spans(document)}
    paths = {
        span
        for span in spans
        if re.fullmatch(r"[\w./-]+(/|\.(py|md|toml|json|csv|pyi))", span) and "/" in span
    }
    named = {path for path in paths if not path.startswith(("~", "/", *MADE_BY_COMMANDS))}
    assert sorted(path for path in named if not exists(path)) == []


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: path.name)
def test_dotted_names_exist(document):
    """Like `physics.matrices.angular_first`, with or without the package's own name before it."""
    missing = []
    for span in code_spans(document):
        if not re.fullmatch(rf"(dq_marine\.)?({SUBPACKAGES})(\.\w+)+", span) or span.endswith(".py"):
            continue
        parts = span.removeprefix("dq_marine.").split(".")
        file = ROOT / "dq_marine" / Path(*parts)
        if not (file.with_suffix(".py").exists() or file.is_dir()) and not names_in(parts[:-1], parts[-1]):
            missing.append(span)
    assert missing == []


def names_in(parts, name):
    path = ROOT / "dq_marine" / Path(*parts)
    source = path / "__init__.py" if path.is_dir() else path.with_suffix(".py")
    if not source.exists():
        return False
    if path.is_dir():
        return hasattr(importlib.import_module(".".join(["dq_marine", *parts])), name)
    tree = ast.parse(source.read_text())
    defined = {node.name for node in tree.body if isinstance(node, ast.ClassDef | ast.FunctionDef)}
    targets = [node.targets[0] for node in tree.body if isinstance(node, ast.Assign)]
    targets += [node.target for node in tree.body if isinstance(node, ast.AnnAssign)]
    return name in defined | {target.id for target in targets if isinstance(target, ast.Name)}


def test_the_architecture_page_has_a_row_for_every_folder():
    page = (ROOT / "docs/architecture.md").read_text()
    folders = [path for path in (ROOT / "dq_marine").iterdir() if (path / "__init__.py").exists()]
    rows = {path.name: f"dq_marine/{path.name}/" for path in folders if not path.is_symlink()}
    rows |= {"envs": "envs/", "agents": "agents/"}
    assert [name for name, row in rows.items() if f"| `{row}`" not in page] == []


def test_old_words_are_gone():
    """The words of the former layout mislead: what they named has other names."""
    old = r"\b(dq_marine[./]kernel|[Ee]ngines?|[Rr]escued?|Doppler log|[Ss]atellite fix|[Rr]ivals?)\b"
    found = {path.name: re.findall(old, path.read_text()) for path in DOCUMENTS}
    assert {name: words for name, words in found.items() if words} == {}
