"""What the preset files say: frozen, validated models."""

from __future__ import annotations

from typing import Annotated, Any, Literal, Self

from pydantic import Field, model_validator

from dq_marine.agents.algorithm_settings import AlgorithmSettings, CrossQSettings, RolloutSettings
from dq_marine.agents.strict_settings import (
    Count,
    Fraction,
    Natural,
    NonNegative,
    Number,
    Positive,
    Settings,
    Truth,
    Whole,
)

PRIVILEGED_KEYWORD = "privileged"
"""Of an environment: what a part of its observation shows that only the simulator knows."""


class LoopSettings(Settings):
    """Where the poles of three axes are placed: (s^2 + 2 zeta w s + w^2)(s + w_i).

    Attributes:
        bandwidth: w [rad/s].
        damping_ratio: zeta.
        integral_rate: w_i [rad/s]; 0 for no integral action.
        integral_reach: errors beyond this are integrated as this [m or rad].
    """

    bandwidth: Positive
    damping_ratio: Positive
    integral_rate: NonNegative
    integral_reach: Positive


class ControllerSettings(Settings):
    """The dynamic positioning controller.

    Attributes:
        position: the three axes of position.
        attitude: the three axes of attitude.
        anti_windup_time: in which the integral gives way to a saturated actuator [s].
    """

    position: LoopSettings
    attitude: LoopSettings
    anti_windup_time: Positive


class AutopilotSettings(Settings):
    """Guidance and autopilot of journeys, as ratios that the vehicle turns into gains.

    Attributes:
        saturating_angle: heading or pitch error that asks for all of the moment at rest [rad].
        saturating_share: error of the speed, over the largest, that asks for all of the thrust.
        fastest_loop: bound of a rate loop's gain times the control period.
        rate_gain: of a rate loop, over its bandwidth.
        angle_gain: of the angle loop round it, over the same.
        angle_of_fastest_rate: angle error that asks for no more than the fastest rate against damping [rad].
        integral_rate: of the rate loop's integral, over the same.
        tightest_turn: radius of the tightest turn that is asked for [vehicle lengths].
        share_of_fastest_turn: largest turn rate that is asked for, over the fastest that full moment holds against
            damping; None for no such limit.
        steepest_pitch: largest pitch that is asked for [rad].
        shortest_look_ahead: of the line of sight [vehicle lengths].
        look_ahead_time: of the line of sight, over the time constant of the angle loop.
        adaptation: of the drift angle, over the rate that damps the path's error critically.
        largest_drift_angle: that adaptation may find [rad].
        bend_margin: radius of bends to a waypoint, over that of the tightest turn at the slowest speed.
        slowing_angle: turn ahead at which a vehicle between waypoints goes slowest [rad].
        haste: speed between waypoints, over the speed of journeys.
        slowest: speed at the slowest, over that between waypoints.
        slowest_of_heavy: the same, of a vehicle that needs more than its length to stop.
    """

    saturating_angle: Positive
    saturating_share: Positive
    fastest_loop: Annotated[Number, Field(gt=0.0, lt=1.0)]
    rate_gain: Positive
    angle_gain: Positive
    angle_of_fastest_rate: Positive
    integral_rate: NonNegative
    tightest_turn: Positive
    share_of_fastest_turn: Positive | None = None
    steepest_pitch: Annotated[Number, Field(gt=0.0, lt=1.5)]
    shortest_look_ahead: Positive
    look_ahead_time: Positive
    adaptation: NonNegative
    largest_drift_angle: Positive
    bend_margin: Positive
    slowing_angle: Positive
    haste: Positive
    slowest: Fraction
    slowest_of_heavy: Fraction


class TrajectorySettings(Settings):
    """Tracking by LQR and by MPC: deviations that count as much as the effort, and what the controllers need besides.

    Attributes:
        position: deviation [m].
        attitude: deviation [rad].
        linear_velocity: deviation [m/s].
        angular_velocity: deviation [rad/s].
        effort: wrench beside that of the reference, over the limits.
        disturbance_time: in which the estimated disturbance follows what the model lacks [s].
        horizon: of the MPC [s].
        iterations: of the MPC's solver in a control period, at most.
    """

    position: Positive
    attitude: Positive
    linear_velocity: Positive
    angular_velocity: Positive
    effort: Positive
    disturbance_time: Positive
    horizon: Annotated[Number, Field(gt=0.0, le=2.0)]
    iterations: Count


class AvoidanceSettings(Settings):
    """The choice of a way among obstacles; costs are in radians off the course to the goal.

    Attributes:
        haste: speed, over the speed of journeys.
        slowest: speed at the slowest, over that: slower, currents would carry a vehicle off.
        look_ahead: how far ahead ways are tried [vehicle lengths].
        margin: room that a way shall leave beside the hull [vehicle lengths].
        softness: room at which the cost of nearness has fallen to 1/e [vehicle lengths].
        nearness: cost of a way that leaves no more than the margin.
        blocked: cost of a way that is blocked at once.
        hysteresis: cost of another course than the last, per radian.
        lasting: how long an echo counts, as way at the speed of journeys [vehicle lengths].
        slowing_room: a vehicle slows down where less of its way is free [vehicle lengths].
    """

    haste: Positive
    slowest: Fraction
    look_ahead: Positive
    margin: NonNegative
    softness: Positive
    nearness: NonNegative
    blocked: NonNegative
    hysteresis: NonNegative
    lasting: NonNegative
    slowing_room: Positive


class GroundSettings(Settings):
    """Flight at an altitude over the ground, as shares of the altitude but for `lead`.

    Attributes:
        width: over which echoes of the ground are smoothed.
        behind: how far behind the vehicle they are kept.
        lead: how far ahead the slope is taken that is followed, over the way in the time constant of the angle loop.
    """

    width: Positive
    behind: NonNegative
    lead: NonNegative


class EnvironmentSettings(Settings):
    """The environment: its registered id and the keywords of `gymnasium.make`."""

    id: str = Field(min_length=1)
    keywords: dict[str, Any] = Field(default_factory=dict)


class NetworkSettings(Settings):
    """The policy's and the critic's hidden layers.

    Attributes:
        layers: of both.
        activation: after each.
        set_layers: that read, before these, each of several things of a kind that are numbered in the observation, such
            as vessels 1 to 3; whichever number they have, they are read alike. Empty: they are read like all the rest.
    """

    layers: tuple[Count, ...] = Field(min_length=1)
    activation: Literal["tanh", "relu"]
    set_layers: tuple[Count, ...] = ()


class NormalisationSettings(Settings):
    """Running normalisation: of what, and the magnitude that normalised numbers are cut at.

    Attributes:
        observation: whether observations are normalised.
        reward: whether rewards are.
        clip: the magnitude.
        symlog: whether of observations sign(x) ln(1 + |x|) is taken before, so that what lies a hundred metres off and
            what lies one metre off are both told apart.
    """

    observation: Truth
    reward: Truth
    clip: Positive
    symlog: Truth = False

    @model_validator(mode="after")
    def _symlog_is_normalised(self) -> Self:
        if self.symlog and not self.observation:
            raise ValueError(
                "normalisation.symlog goes before the normalisation of observations, and normalisation.observation = "
                "false; set it true, or leave symlog out"
            )
        return self


class EvaluationSettings(Settings):
    """Evaluation while training: after how many steps, over how many episodes."""

    every: Count
    episodes: Count


class ImitationSettings(Settings):
    """How a policy begins as the copy of a baseline.

    Attributes:
        teacher: the baseline.
        episodes: that it flies.
        noise: standard deviation of what its actions are disturbed by while it flies, over the actuators' reach.
        epochs: how often what it flew is learned from.
        batch_size: of control periods; a policy that remembers learns 16 stretches side by side, each a 16th as long.
        learning_rate: of this beginning.
        final_learning_rate: to which that falls, linearly from epoch to epoch. None keeps it as it is, or lets it fall
            to a twentieth where the policy remembers.
        rounds: thereafter, in each of which the policy flies as many episodes itself, and learns what the teacher would
            have done there.
        turns: control periods, on the mean, after which policy and teacher take turns in these rounds; what the teacher
            does is then learned only while it flies. At 0 the policy flies throughout, and all is learned: a teacher
            whose integrals run away while another flies teaches nonsense there.
        forgetful: whether the teacher forgets before each period what came before. What it does then follows from what
            is seen alone, as what the policy does will, whoever has flown; it must be able to fly so.
        keeping: how much it costs, where a memory is learned from, to do other than the copy did: the mean square of
            the difference counts so many times as much as values over their mean magnitude. None is 4; PPO, which
            takes small steps, has none.
    """

    teacher: Literal["controller", "lqr", "mpc"] = "controller"
    episodes: Count = 40
    noise: Annotated[Number, Field(ge=0.0, le=1.0)] = 0.1
    epochs: Count = 20
    batch_size: Count = 256
    learning_rate: Positive = 1e-3
    final_learning_rate: Positive | None = None
    rounds: Annotated[Whole, Field(ge=0, le=100)] = 0
    turns: Natural = 0
    forgetful: Truth = False
    keeping: NonNegative | None = None

    @model_validator(mode="after")
    def _turns_are_taken_in_rounds(self) -> Self:
        if self.turns and not self.rounds:
            raise ValueError(
                f"imitation.turns = {self.turns} counts in further rounds, and imitation.rounds = 0; ask for rounds, "
                "or leave turns out"
            )
        return self


class CurriculumSettings(Settings):
    """Levels that are learned before the environment's own, one after the other.

    Attributes:
        levels: of the task's, the easiest first.
        success: share of the last episodes that must succeed before the next level; at 0, that many must end.
        episodes: how many that are.
    """

    levels: tuple[str, ...] = Field(min_length=1)
    success: Fraction = 0.8
    episodes: Count = 100


class TrainingSettings(Settings):
    """Everything that a training run follows from, together with its seed.

    Attributes:
        timesteps: control periods to learn from, over all environments.
        envs: environments stepped in turn.
        torch_threads: processor threads that torch may use.
        checkpoint_every: timesteps between checkpoints.
        environment: what to learn for.
        algorithm: what to learn with.
        network: what to learn.
        normalisation: of observations and rewards.
        evaluation: while training, on environments of its own.
        imitation: how the policy begins as the copy of a baseline; None where it begins with nothing learned.
        curriculum: levels that are learned first; None for the environment's own from the start.
        privileged_critic: what the critic sees of what only the simulator knows: the current, in what the vehicle is
            not the nominal one, the truth behind sensors and delays. The policy that is learned does not.
        while_learning: keywords of the environment that hold while it is learned in, such as a larger distance to keep
            than the policy will have to; evaluations are in the environment as it is.
    """

    timesteps: Count
    envs: Count
    torch_threads: Count
    checkpoint_every: Count
    environment: EnvironmentSettings
    algorithm: AlgorithmSettings
    network: NetworkSettings
    normalisation: NormalisationSettings
    evaluation: EvaluationSettings
    imitation: ImitationSettings | None = None
    curriculum: CurriculumSettings | None = None
    privileged_critic: tuple[Literal["current", "vehicle", "truth"], ...] = ()
    while_learning: dict[str, Any] = Field(default_factory=dict)

    @property
    def learned_in(self) -> EnvironmentSettings:
        """The environment as it is learned in, with what only the critic sees."""
        return self._shown_to_critic({**self.environment.keywords, **self.while_learning})

    @property
    def evaluated_in(self) -> EnvironmentSettings:
        """The environment as it is, with what only the critic sees."""
        return self._shown_to_critic(self.environment.keywords)

    def _shown_to_critic(self, keywords: dict[str, Any]) -> EnvironmentSettings:
        if self.privileged_critic:
            keywords = {**keywords, PRIVILEGED_KEYWORD: list(self.privileged_critic)}
        return EnvironmentSettings(id=self.environment.id, keywords=keywords)

    @model_validator(mode="after")
    def _batches_fit(self) -> Self:
        if isinstance(self.algorithm, RolloutSettings):
            collected = self.envs * self.algorithm.n_steps
            if collected % self.algorithm.minibatches or collected < 2 * self.algorithm.minibatches:
                raise ValueError(
                    f"algorithm.minibatches = {self.algorithm.minibatches} does not cut envs x n_steps = "
                    f"{self.envs} x {self.algorithm.n_steps} = {collected} into equal parts of 2 or more; "
                    "change one of the three"
                )
        return self

    @model_validator(mode="after")
    def _copies_are_kept_by_what_remembers(self) -> Self:
        kept = None if self.imitation is None else self.imitation.keeping
        if kept is not None and isinstance(self.algorithm, RolloutSettings):
            raise ValueError(
                f"imitation.keeping = {kept} goes with algorithms that learn from a memory, and algorithm.name = "
                f"{self.algorithm.name!r}; leave it out: small steps keep the copy there"
            )
        return self

    @model_validator(mode="after")
    def _critic_can_see_more(self) -> Self:
        if self.privileged_critic and isinstance(self.algorithm, CrossQSettings):
            raise ValueError(
                f"privileged_critic = {list(self.privileged_critic)}, and algorithm.name = 'crossq', whose critic "
                "takes no observations in parts; train with ppo, recurrent_ppo, sac, td3 or tqc, or leave "
                "privileged_critic out"
            )
        if self.privileged_critic and self.network.set_layers:
            raise ValueError(
                f"privileged_critic = {list(self.privileged_critic)} makes observations of parts, which "
                f"network.set_layers = {list(self.network.set_layers)} do not read; leave one of them out"
            )
        if PRIVILEGED_KEYWORD in {**self.environment.keywords, **self.while_learning}:
            raise ValueError(
                f"the environment's keyword {PRIVILEGED_KEYWORD} would show the policy what no sensor tells; set "
                "privileged_critic, which shows it to the critic alone"
            )
        return self
