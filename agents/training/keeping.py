"""What keeps a policy near the copy that it began as, while it learns from a memory.

Critics are wrong about actions that nobody has flown, and a policy that follows them alone has forgotten within some
thousand updates what it had copied. It therefore makes small, with its copy in place of the actions of a data set
(Fujimoto and Gu 2021, arXiv:2106.06860, equations 3 to 5),

    -Q(s, pi(s)) / mean |Q| + keeping * mean (pi(s) - copy(s))^2.

When Stable-Baselines3's optimiser is about to step, the gradient of the first term is computed: here it is divided by
the mean magnitude, and that of the second is added.
"""

from __future__ import annotations

import copy
from typing import Any

from dq_marine.agents.training.fitting_replay import acted, values
from dq_marine.agents.training.remembering import memory_of
from dq_marine.util.extras import extra_needed

with extra_needed("training", "agents"):
    import torch
    from stable_baselines3.common.off_policy_algorithm import OffPolicyAlgorithm
    from torch.nn.functional import mse_loss

KEPT = "kept_copy"
"""Attribute of a model: its copy, and by how much it is kept; Stable-Baselines3 saves it with the model."""

LEAST = 1e-6
"""Magnitude of values that is divided by at the least: where nothing was ever earned, values may be zero."""


def keep_copy(model: OffPolicyAlgorithm, keeping: float) -> None:
    """Let a model keep to what its actor does now, while it learns."""
    actor: Any = model.policy.actor
    kept = copy.deepcopy(actor).requires_grad_(False).eval()
    del kept.optimizer
    setattr(model, KEPT, (kept, keeping))
    go_on_keeping(model)


def go_on_keeping(model: OffPolicyAlgorithm) -> None:
    """Let a model keep to its copy, if it has one; one that was loaded does so from here on."""
    if not hasattr(model, KEPT):
        return
    kept, keeping = getattr(model, KEPT)
    policy: Any = model.policy

    def pull(optimiser: Any, arguments: Any, keywords: Any) -> None:
        batch = memory_of(model).sample(model.batch_size, env=model.get_vec_normalize_env())
        observations = batch.observations
        own, _ = acted(policy.actor, observations)
        with torch.no_grad():
            copied, _ = acted(kept, observations)
            magnitude = torch.cat(values(policy, observations, own), dim=1).abs().mean().clamp(min=LEAST)
        for parameter in policy.actor.parameters():
            if parameter.grad is not None:
                parameter.grad /= magnitude
        (keeping * mse_loss(own, copied)).backward()

    policy.actor.optimizer.register_step_pre_hook(pull)
