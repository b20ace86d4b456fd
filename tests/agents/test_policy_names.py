"""What policies go by: short names that differ."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from dq_marine.agents.policies import named_policies

HUB = "/home/me/.cache/huggingface/hub/models--{}--{}/snapshots/0123abcd/policy.onnx"


@pytest.mark.parametrize(
    ("paths", "names"),
    [
        ([], []),
        (["/runs/ppo"], ["ppo"]),
        (["/runs/ppo", "/runs/station.onnx"], ["ppo", "station"]),
        (["/a/ppo", "/b/ppo"], ["a-ppo", "b-ppo"]),
        (["/x/a/ppo", "/y/a/ppo", "/z/sac"], ["x-a-ppo", "y-a-ppo", "z-sac"]),
        (["/a/policy.onnx", "/b/policy.onnx"], ["a-policy", "b-policy"]),
        ([HUB.format("me", "station")], ["station"]),
        ([HUB.format("me", "station"), HUB.format("me", "docking")], ["station", "docking"]),
        ([HUB.format("me", "station"), HUB.format("you", "station")], ["me-station", "you-station"]),
        (["/runs/ppo", "/runs/ppo"], ["ppo", "ppo"]),  # the same one: whoever asks for both refuses it
        (["policy.onnx"], ["policy"]),
        (["/policy.onnx", "/"], ["policy", ""]),
    ],
)
def test_names_are_as_short_as_can_be(paths: list[str], names: list[str]) -> None:
    given = [Path(one) for one in paths]
    assert named_policies(given) == list(zip(names, given, strict=True))


WORDS = st.sampled_from(["a", "b", "runs", "ppo", "policy.onnx"])
PATHS = st.lists(WORDS, min_size=1, max_size=4).map(lambda parts: Path(os.sep, *parts))


@given(st.lists(PATHS, max_size=5, unique=True))
def test_different_policies_have_different_names_or_are_told_by_their_paths(paths: list[Path]) -> None:
    assert len({name for name, _ in named_policies(paths)}) == len(paths)
