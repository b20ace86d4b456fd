"""The learning algorithms' hyperparameters, by the names that Stable-Baselines3 and its sb3-contrib give them.

One is said otherwise for all: the learning rate falls linearly, to `final_learning_rate`.
"""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal, Self

from pydantic import Field, model_validator

from dq_marine.agents.strict_settings import (
    Count,
    Fraction,
    Natural,
    NonNegative,
    Number,
    Positive,
    Settings,
    Truth,
)

EntropyCoefficient = Literal["auto"] | NonNegative


class LearnerSettings(Settings):
    """What all algorithms have.

    Attributes:
        OF_THE_POLICY: fields that are keywords of the policy, not of the algorithm.
    """

    OF_THE_POLICY: ClassVar[tuple[str, ...]] = ()

    learning_rate: Positive
    final_learning_rate: Positive
    gamma: Fraction


class RolloutSettings(LearnerSettings):
    """Those of algorithms that learn from what was just collected.

    Attributes:
        minibatches: into which that is cut: the batch size follows from the number of environments.
    """

    OF_THE_POLICY: ClassVar[tuple[str, ...]] = ("log_std_init",)

    n_steps: Count
    minibatches: Count
    n_epochs: Count
    gae_lambda: Fraction
    clip_range: Positive
    ent_coef: NonNegative
    vf_coef: NonNegative
    max_grad_norm: Positive
    log_std_init: Number


class PPOSettings(RolloutSettings):
    """Those of PPO."""

    name: Literal["ppo"]


class RecurrentPPOSettings(RolloutSettings):
    """Those of PPO with a network that remembers: a long short-term memory before the layers.

    Attributes:
        enable_critic_lstm: whether the critic remembers, too; it learns faster where it need not.
    """

    OF_THE_POLICY = ("log_std_init", "lstm_hidden_size", "enable_critic_lstm")

    name: Literal["recurrent_ppo"]
    lstm_hidden_size: Count
    enable_critic_lstm: Truth = True


class ReplaySettings(LearnerSettings):
    """Those of algorithms that learn from all they remember."""

    buffer_size: Count
    learning_starts: Natural
    batch_size: Count
    train_freq: Count
    gradient_steps: Count


class SACSettings(ReplaySettings):
    """Those of SAC."""

    name: Literal["sac"]
    tau: Fraction
    ent_coef: EntropyCoefficient


class TD3Settings(ReplaySettings):
    """Those of TD3.

    Attributes:
        exploration_noise: standard deviation of what is added to actions while learning, over their range of [-1, 1].
    """

    name: Literal["td3"]
    tau: Fraction
    policy_delay: Count
    target_policy_noise: NonNegative
    target_noise_clip: NonNegative
    exploration_noise: NonNegative


class TQCSettings(ReplaySettings):
    """Those of TQC: SAC with critics that tell quantiles, of which the largest are dropped."""

    OF_THE_POLICY = ("n_quantiles", "n_critics")

    name: Literal["tqc"]
    tau: Fraction
    ent_coef: EntropyCoefficient
    n_quantiles: Count
    n_critics: Count
    top_quantiles_to_drop_per_net: Natural

    @model_validator(mode="after")
    def _some_are_kept(self) -> Self:
        if self.top_quantiles_to_drop_per_net >= self.n_quantiles:
            raise ValueError(
                f"top_quantiles_to_drop_per_net = {self.top_quantiles_to_drop_per_net} leaves none of n_quantiles = "
                f"{self.n_quantiles}; drop fewer"
            )
        return self


class CrossQSettings(ReplaySettings):
    """Those of CrossQ: SAC without target networks, whose layers are normalised by batches instead."""

    OF_THE_POLICY = ("renorm_warmup_steps",)

    name: Literal["crossq"]
    ent_coef: EntropyCoefficient
    policy_delay: Count
    renorm_warmup_steps: Natural


AlgorithmSettings = Annotated[
    PPOSettings | RecurrentPPOSettings | SACSettings | TD3Settings | TQCSettings | CrossQSettings,
    Field(discriminator="name"),
]
"""Of any of them; `name` says which."""
