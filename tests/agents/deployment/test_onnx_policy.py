"""Exported policies in flight, and what is refused: damaged, foreign and unfitting files."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import onnx
import pytest
from support.command_line import assert_refused, run
from support.sweeps import sweep

from dq_marine.agents.deployment.description import METADATA_KEY
from dq_marine.agents.deployment.onnx_policy import OnnxPolicy
from dq_marine.agents.deployment.seal import SEAL_KEY, UNSEALED, sealed
from dq_marine.agents.environments import make_environment
from dq_marine.agents.evaluation.episodes import fly_episode
from dq_marine.agents.policy_names import policy_path
from dq_marine.agents.settings import EnvironmentSettings
from dq_marine.agents.training.trained_policy import TrainedPolicy
from dq_marine.errors import InvalidInputError, MissingDependencyError
from dq_marine.report.leaderboard import Entry, Plan, fly_entry
from dq_marine.report.leaderboard_policies import policies_of

STATION = "dq_marine/StationKeeping-v0"

DAMAGED = r"is no policy that dq-marine exported|is damaged"


@pytest.mark.parametrize("algorithm", ["ppo", "sac", "recurrent_ppo"])
def test_an_episode_is_that_of_the_run(algorithm: str, request: pytest.FixtureRequest) -> None:
    made = request.getfixturevalue(algorithm)
    policy = OnnxPolicy(made.onnx)
    env = make_environment(policy.description.environment)
    ours, theirs = (fly_episode(env, one, seed=3) for one in (policy, TrainedPolicy(made.run)))
    assert len(ours.time) == 31
    np.testing.assert_allclose(ours.actions, theirs.actions, rtol=0.0, atol=1e-5)
    for name, values in theirs.measured.items():
        np.testing.assert_allclose(ours.measured[name], values, rtol=0.0, atol=1e-5)
    assert ours.total_reward == pytest.approx(theirs.total_reward, abs=1e-4)


def test_what_it_remembers_is_of_the_episode_alone(recurrent_ppo: Any) -> None:
    policy = OnnxPolicy(recurrent_ppo.onnx)
    assert policy.description.memory == 16
    env = make_environment(policy.description.environment)
    observation, _ = env.reset(seed=3)
    policy.reset(env)
    first, second = policy.act(observation), policy.act(observation)
    assert (first != second).any()
    policy.reset(env)
    assert np.array_equal(policy.act(observation), first)
    both = policy.act(np.stack([observation, observation]))  # a batch begins anew, and goes on by itself
    assert np.allclose(both, first, rtol=0.0, atol=1e-6)
    assert np.allclose(policy.act(np.stack([observation, observation])), second, rtol=0.0, atol=1e-6)


@pytest.mark.parametrize(
    "command",
    sweep(["fly", "evaluate", "compare", "leaderboard"], plain=["fly"]),
)
def test_flying_imports_neither_torch_nor_stable_baselines3(command: str, ppo: Any, tmp_path: Path) -> None:
    arguments = {
        "fly": ["fly", "--seconds", "1", "--trajectory", str(tmp_path / "flight.csv")],
        "evaluate": ["evaluate", "--episodes", "1"],
        "compare": ["compare", "--seconds", "1", "--html", str(tmp_path / "page.html")],
        "leaderboard": [
            *(
                "leaderboard",
                "--scenarios",
                "--episodes",
                "0",
                "--task",
                "StationKeeping",
                "--processes",
                "1",
            ),
            *("--vehicle", "bluerov2_heavy", "--out", str(tmp_path / "page.md")),
        ],
    }[command]
    program = (
        "import sys\n"
        "class Absent:\n"
        "    def find_spec(name, path, target=None):\n"
        "        if name in ('torch', 'stable_baselines3', 'onnx'): raise ModuleNotFoundError(name, name=name)\n"
        "sys.meta_path.insert(0, Absent)\n"
        "from dq_marine.cli.main import app\n"
        "app(sys.argv[1:], standalone_mode=False)\n"
        "print('torch' in sys.modules, 'onnxruntime' in sys.modules)"
    )
    child = subprocess.run(
        [sys.executable, "-c", program, *arguments, "--policy", str(ppo.onnx)],
        capture_output=True,
        text=True,
    )
    assert child.returncode == 0, child.stderr
    assert child.stdout.splitlines()[-1] == "False True"
    if command == "fly":
        assert len((tmp_path / "flight.csv").read_text().splitlines()) == 12
    elif command in ("evaluate", "compare"):
        assert "policy" in child.stdout
    else:
        assert "policy" in (tmp_path / "page.md").read_text()


def test_a_leaderboard_entry_is_flown_by_the_file(ppo: Any) -> None:
    (policy,) = policies_of([ppo.onnx])
    assert (policy.name, policy.task, policy.vehicle) == ("policy", STATION, "bluerov2_heavy")
    assert policy.fits(EnvironmentSettings(id=STATION, keywords={"level": "easy"}))
    assert not policy.fits(EnvironmentSettings(id=STATION, keywords={"actuation": "thrusters"}))
    result = fly_entry(Entry(STATION, "bluerov2_heavy", "", "policy", "head_current"), Plan(0, 0), policy)
    assert result.policy == policy.digest
    (own,) = policies_of([ppo.run.path])
    theirs = fly_entry(Entry(STATION, "bluerov2_heavy", "", "ppo", "head_current"), Plan(0, 0), own)
    assert result.score["returns"]["mean"] == pytest.approx(theirs.score["returns"]["mean"], abs=1e-3)


@pytest.mark.parametrize(
    ("keywords", "differing"),
    [
        ({"actuation": "thrusters"}, "no action surge; .*action bow starboard besides"),
        ({"sensors": "auv"}, "observation .* besides"),
    ],
)
def test_an_environment_that_does_not_fit_is_refused_by_name(
    keywords: dict[str, Any], differing: str, ppo: Any, tmp_path: Path
) -> None:
    env = make_environment(EnvironmentSettings(id=STATION, keywords=keywords))
    with pytest.raises(InvalidInputError, match=f"trained in {STATION} with BlueROV2 Heavy; .*{differing}"):
        OnnxPolicy(ppo.onnx).reset(env)
    (name, value), *_ = keywords.items()
    out = ("--trajectory", tmp_path / "flight.csv")
    assert_refused(run("fly", "--policy", ppo.onnx, "--set", f"{name}={value}", *out), differing)


def test_of_many_differences_a_few_are_named_and_the_rest_counted() -> None:
    elsewhere = make_environment(EnvironmentSettings(id="dq_marine/Docking-v0"))
    with pytest.raises(
        InvalidInputError, match=r"no observation starboard_of_route; .*24 more observations missing"
    ) as caught:
        OnnxPolicy(policy_path("Encounter")).reset(elsewhere)
    assert len(str(caught.value)) < 700


def test_damaged_files_are_refused_before_they_are_read(ppo: Any, tmp_path: Path) -> None:
    whole, file = ppo.onnx.read_bytes(), tmp_path / "policy.onnx"
    rng = np.random.default_rng(2)
    for length in (0, 1, *rng.integers(0, len(whole), 30)):
        file.write_bytes(whole[:length])
        with pytest.raises(InvalidInputError, match=DAMAGED):
            OnnxPolicy(file)
    for place in rng.integers(0, len(whole), 200):
        changed = bytearray(whole)
        changed[place] ^= 1 << int(rng.integers(8))
        file.write_bytes(changed)
        with pytest.raises(InvalidInputError, match=DAMAGED):
            OnnxPolicy(file)
    file.write_bytes(whole)
    OnnxPolicy(file)


def resealed(content: bytes, **changes: str) -> bytes:
    """Return a file with other metadata, as one who means it would write it."""
    model = onnx.load_from_string(content)
    onnx.helper.set_model_props(model, {**changes, SEAL_KEY: UNSEALED})
    return sealed(model.SerializeToString(deterministic=True))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"environment": {"id": "antigravity:dq_marine/StationKeeping-v0"}}, "would import a module"),
        ({"control_period": 0.0}, "control_period: Input should be greater than 0"),
        ({"format": 2}, "format: Input should be 1"),
        ({"surprise": 1}, "surprise: Extra inputs are not permitted"),
        (
            {"actions": [{"name": "surge", "unit": "N", "low": -1, "high": 1}]},
            "not what its description says",
        ),
    ],
)
def test_descriptions_that_are_wrong_are_refused(
    change: dict[str, Any], message: str, ppo: Any, tmp_path: Path
) -> None:
    file = tmp_path / "policy.onnx"
    description = json.loads(OnnxPolicy(ppo.onnx).description.model_dump_json()) | change
    file.write_bytes(resealed(ppo.onnx.read_bytes(), **{METADATA_KEY: json.dumps(description)}))
    assert_refused(run("fly", "--policy", file, "--seconds", "1"), message)
    assert "antigravity" not in sys.modules


@pytest.mark.parametrize("text", ["", "[", "[" * 100_000, "null", "\x00", '{"format": 1}', "1" * (1 << 21)])
def test_what_is_no_description_is_refused(text: str, ppo: Any, tmp_path: Path) -> None:
    file = tmp_path / "policy.onnx"
    file.write_bytes(resealed(ppo.onnx.read_bytes(), **{METADATA_KEY: text}))
    with pytest.raises(InvalidInputError, match="describes its policy wrongly"):
        OnnxPolicy(file)


def test_other_files_and_none_are_refused(ppo: Any, tmp_path: Path) -> None:
    identity = onnx.helper.make_node("Identity", ["observation"], ["action"])
    values = [
        onnx.helper.make_tensor_value_info(name, onnx.TensorProto.FLOAT, ["batch", 6])
        for name in ("observation", "action")
    ]
    graph = onnx.helper.make_graph([identity], "foreign", values[:1], values[1:])
    foreign = onnx.helper.make_model(graph, opset_imports=[onnx.helper.make_opsetid("", 18)])
    for content in (foreign.SerializeToString(), ppo.torchscript.read_bytes(), b"\x80\x04."):
        (tmp_path / "foreign.onnx").write_bytes(content)
        assert_refused(
            run("fly", "--policy", tmp_path / "foreign.onnx"), "is no policy that dq-marine exported"
        )
    assert_refused(run("evaluate", "--policy", tmp_path / "none.onnx"), "there is no file .*none.onnx")
    assert_refused(run("evaluate", "--policy", tmp_path / "none.pt"), "holds no run")
    (tmp_path / "broken.onnx").write_bytes(sealed(SEAL_KEY.encode() + b"\x12\x40" + UNSEALED.encode()))
    assert_refused(run("evaluate", "--policy", tmp_path / "broken.onnx"), "onnxruntime cannot load")
    two = run("fly", "--policy", ppo.onnx, "--run", ppo.run.path, "--agent", "zero")
    assert_refused(two, "--agent zero and --run .* and --policy .* name three agents")


def test_onnxruntime_is_asked_for_by_its_extra(ppo: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "onnxruntime", None)
    with pytest.raises(MissingDependencyError, match=r"dq-marine\[deploy\]"):
        OnnxPolicy(ppo.onnx)
