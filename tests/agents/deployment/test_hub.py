"""Policies on a Hugging Face Hub of our own, by its real client: shared, fetched, flown, refused."""

from __future__ import annotations

import shutil
import sys
from collections.abc import Iterator
from pathlib import Path

import huggingface_hub.constants
import pytest
from support.command_line import assert_refused, run
from support.fake_hub import FakeHub, served

from dq_marine.agents.deployment.hub import fetched, share
from dq_marine.agents.deployment.onnx_policy import OnnxPolicy
from dq_marine.agents.policies import load_policy, trained_environment
from dq_marine.errors import InvalidInputError, MissingDependencyError


@pytest.fixture
def hub(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[FakeHub]:
    """A hub that the client takes for the one."""
    hub = FakeHub()
    with served(hub) as address:
        lead_to(address, tmp_path, monkeypatch)
        yield hub


def lead_to(address: str, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Have the client call an address, as HF_ENDPOINT would before it is imported, and keep its cache in a folder."""
    constants = huggingface_hub.constants
    template = constants.HUGGINGFACE_CO_URL_TEMPLATE.replace(constants.ENDPOINT, address)
    monkeypatch.setattr(constants, "HUGGINGFACE_CO_URL_TEMPLATE", template)
    monkeypatch.setattr(constants, "ENDPOINT", address)
    monkeypatch.setattr(constants, "HF_HUB_CACHE", str(folder / "cache"))


def test_what_is_shared_is_what_is_flown(ppo, hub: FakeHub, tmp_path: Path) -> None:
    folder = Path(shutil.copytree(ppo.onnx.parent, tmp_path / "mine"))
    (folder / "notes.txt").write_text("stays here")
    shutil.copytree(ppo.run.path, folder / "run")
    result = run("share", folder, "me/station")
    assert result.exit_code == 0, result.output
    assert "dq-marine fly --policy hf://me/station" in result.output
    (first,) = hub.repositories["me/station"]
    kept = hub.repositories["me/station"][first]
    assert kept == {name: (folder / name).read_bytes() for name in ("policy.onnx", "policy.pt", "README.md")}

    assert fetched("hf://me/station").read_bytes() == ppo.onnx.read_bytes()
    hub.commit("me/station", {"policy.onnx": b"of a later commit"})
    assert fetched(f"hf://me/station@{first}").read_bytes() == ppo.onnx.read_bytes()
    assert trained_environment(f"hf://me/station@{first}") == trained_environment(ppo.onnx)
    assert isinstance(load_policy(f"hf://me/station@{first}"), OnnxPolicy)
    result = run("evaluate", "--policy", f"hf://me/station@{first}", "--episodes", "1")
    assert result.exit_code == 0, result.output
    assert "station" in result.stdout
    result = run("fly", "--policy", "hf://me/station", "--seconds", "1")
    assert result.exit_code == 1
    assert "policy.onnx is no policy that dq-marine exported" in result.stderr.splitlines()[-1]


def test_only_onnx_is_taken_from_the_hub(ppo, hub: FakeHub) -> None:
    hub.create("me/run")
    snapshot = ppo.run.trained_snapshot
    pickled = {f"best/000001/{one.name}": one.read_bytes() for one in snapshot.iterdir()}
    hub.commit("me/run", {"run.json": (ppo.run.path / "run.json").read_bytes(), **pickled})
    with pytest.raises(InvalidInputError, match=r"holds 0 \.onnx files .* nothing else is loaded"):
        fetched("hf://me/run")
    cache = Path(huggingface_hub.constants.HF_HUB_CACHE)
    assert not [one for one in cache.rglob("*") if one.suffix in (".zip", ".pkl")]
    hub.commit("me/run", {"a.onnx": b"", "b.onnx": b""})
    with pytest.raises(InvalidInputError, match=r"holds 2 \.onnx files \(a\.onnx, b\.onnx\)"):
        fetched("hf://me/run")


@pytest.mark.parametrize("address", ["hf://me/nothing", "hf://", "hf://a/b/c", "hf://me/../nothing"])
def test_what_the_hub_has_not_is_refused(hub: FakeHub, address: str) -> None:
    assert_refused(run("evaluate", "--policy", address, "--episodes", "1"), "the Hugging Face Hub refuses")


def test_a_hub_that_is_not_there_is_an_error_of_ours(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    lead_to("http://127.0.0.1:1", tmp_path, monkeypatch)
    with pytest.raises(InvalidInputError, match="the Hugging Face Hub refuses 'me/station'"):
        fetched("hf://me/station")


def test_folders_without_a_policy_are_not_shared(ppo, hub: FakeHub, tmp_path: Path) -> None:
    with pytest.raises(InvalidInputError, match=r"holds 0 \.onnx files and no README\.md"):
        share(ppo.run.path, "me/run")
    shutil.copy(ppo.onnx, tmp_path / "policy.onnx")
    with pytest.raises(InvalidInputError, match=r"holds 1 \.onnx files and no README\.md"):
        share(tmp_path, "me/run")
    (tmp_path / "README.md").write_text("mine")
    (tmp_path / "policy.onnx").write_bytes(b"damaged")
    with pytest.raises(InvalidInputError, match="is no policy that dq-marine exported"):
        share(tmp_path, "me/run")
    assert hub.repositories == {}


def test_the_client_is_asked_for_by_its_extra(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "huggingface_hub", None)
    with pytest.raises(MissingDependencyError, match=r"dq-marine\[hub\]"):
        fetched("hf://me/station")
