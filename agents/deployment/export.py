"""Writing a trained policy as files that fly without Stable-Baselines3, with a card beside them."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from dq_marine.agents.deployment.description import PolicyDescription, described
from dq_marine.agents.deployment.formats import FORMATS
from dq_marine.agents.deployment.graph import PolicyGraph
from dq_marine.agents.deployment.model_card import CARD_FILE, Evaluated, card
from dq_marine.agents.environments import make_environment
from dq_marine.agents.evaluation.evaluation import evaluate
from dq_marine.agents.training.run_folder import RunFolder, RunPlan
from dq_marine.agents.training.snapshots import read_progress
from dq_marine.agents.training.trained_policy import TrainedPolicy
from dq_marine.checks import whole_number
from dq_marine.errors import InvalidInputError
from dq_marine.util.files import check_targets, with_folder, write_whole


@dataclass(frozen=True)
class Exported:
    """What was written.

    Attributes:
        files: all of them, the card last.
        description: that the policy's files hold.
        evaluated: what stands in the card; None if no episodes were flown.
    """

    files: tuple[Path, ...]
    description: PolicyDescription
    evaluated: Evaluated | None


def export_policy(
    run: RunFolder,
    targets: Sequence[Path],
    *,
    episodes: int = 50,
    seed: int = 0,
    force: bool = False,
    progress: Callable[[float], None] = lambda done: None,
) -> Exported:
    """Export the best policy of a run, evaluate it, and write its card into the same folder.

    Args:
        run: whose policy is exported. It is unpickled: give only runs that you trust.
        targets: files of one folder, which is made if need be; .onnx, or .pt for TorchScript.
        episodes: to fly for the card; 0 for none.
        seed: of the first of them.
        force: replace files that are there, the card among them.
        progress: is told what part of the episodes is flown, from 0 to 1.

    Raises:
        InvalidInputError: a target is wrong or there already, or the run has no policy that can be exported.
        MissingDependencyError: a library that exporting needs is not installed.
    """
    episodes = whole_number("episodes", episodes, least=0)
    seed = whole_number("seed", seed, least=0)
    card_file = _checked_targets(targets, force=force)
    plan, policy = run.read_plan(), TrainedPolicy(run)
    graph = PolicyGraph(policy.model, policy.normalisation)
    description = described(
        plan.settings.environment,
        algorithm=plan.settings.algorithm.name,
        seed=plan.seed,
        timesteps=read_progress(run.trained_snapshot).timesteps,
        versions=plan.versions,
        memory=graph.memory_size,
    )
    contents = {target: FORMATS[target.suffix](graph, description) for target in targets}
    evaluated = _evaluated(plan, policy, episodes, seed, progress) if episodes else None
    for target, content in contents.items():
        write_whole(with_folder(target), content)
    write_whole(card_file, card(targets, plan, description, evaluated))
    return Exported((*targets, card_file), description, evaluated)


def _evaluated(
    plan: RunPlan, policy: TrainedPolicy, episodes: int, seed: int, progress: Callable[[float], None]
) -> Evaluated:
    """Fly episodes in the environment of the training."""
    flown = itertools.count(1)
    env = make_environment(plan.settings.environment)
    (score,) = evaluate(
        env,
        {plan.settings.algorithm.name: policy},
        episodes=episodes,
        seed=seed,
        after_episode=lambda agent, episode: progress(next(flown) / episodes),
    )
    env.close()
    return Evaluated(score, seed)


def _checked_targets(targets: Sequence[Path], *, force: bool) -> Path:
    """Return the file of the card, once it and the targets may be written."""
    if not targets:
        raise InvalidInputError("nothing to write; name a file that ends in .onnx or .pt")
    for target in targets:
        if target.suffix not in FORMATS:
            raise InvalidInputError(
                f"{target} has the ending {target.suffix!r}; give a file that ends in .onnx, or in .pt for TorchScript"
            )
        if target.parent != targets[0].parent:
            raise InvalidInputError(
                f"{target} and {targets[0]} are in two folders; give files of one folder, which gets the card"
            )
    card_file = targets[0].parent / CARD_FILE
    check_targets(targets, force=force)
    if card_file.exists() and not force:
        raise InvalidInputError(
            f"{card_file} exists, and the card would take its place; export into a folder of its own, or replace it "
            "with --force"
        )
    check_targets([card_file], force=force)
    return card_file
