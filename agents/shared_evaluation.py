"""Evaluating with a team: the same seeded episodes as `evaluate` flies, shared out among processes or machines."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import as_completed
from dataclasses import dataclass
from pathlib import Path

from dq_marine.agents.choice import make_agents
from dq_marine.agents.controllers.baselines import DRAWING
from dq_marine.agents.environments import make_environment
from dq_marine.agents.evaluation.episodes import Episode, fly_episode
from dq_marine.agents.evaluation.evaluation import Score, score
from dq_marine.agents.policies import named_policies
from dq_marine.agents.settings import EnvironmentSettings
from dq_marine.util.side_by_side import Team

EPISODES_OF_A_SHARE = 10
"""Enough that what flies them need not be made for each, few enough that all have something to do at the end."""


@dataclass(frozen=True)
class Share:
    """Some of an agent's episodes, which one of a team flies.

    Attributes:
        environment: to fly in.
        agent: its name.
        policy: of the agent, absolute; None for a baseline.
        seed: of an agent that draws.
        seeds: of the episodes.
        track: whether episodes keep where the vehicle was.
    """

    environment: EnvironmentSettings
    agent: str
    policy: Path | None
    seed: int
    seeds: range
    track: bool


def evaluate_by_team(
    environment: EnvironmentSettings,
    baselines: Sequence[str],
    policies: Sequence[Path],
    *,
    episodes: int,
    seed: int,
    team: Team,
    after_episode: Callable[[str, Episode], None] = lambda agent, episode: None,
    track: bool = False,
) -> list[Score]:
    """Fly episodes seeded seed, seed + 1, ... with every agent; the scores are those of `evaluate`.

    Args:
        environment: to fly in.
        baselines: agents by name.
        policies: paths of trained ones, which each of the team sees.
        episodes: of each agent, at least 1.
        seed: of the first episode, and of agents that draw.
        team: who fly.
        after_episode: called here with the agent's name and the episode, whenever a share has been flown.
        track: whether episodes keep where the vehicle was.

    Raises:
        InvalidInputError: an agent is unknown or cannot fly here, or there is no policy at a path.
        MissingDependencyError: a library that an agent needs is not installed.
    """
    seeds = range(seed, seed + episodes)
    agents: list[tuple[str, Path | None]] = [(name, None) for name in baselines]
    agents += [(name, policy.absolute()) for name, policy in named_policies(policies)]
    shares = [
        Share(environment, name, policy, seed, part, track)
        for name, policy in agents
        for part in _parts(seeds, whole=name in DRAWING and policy is None)
    ]
    flown: dict[str, dict[int, Episode]] = {name: {} for name, _ in agents}
    with team(len(shares)) as pool:
        flights = {pool.submit(fly_share, share): share for share in shares}
        for done in as_completed(flights):
            agent = flights[done].agent
            for episode in done.result():
                flown[agent][episode.seed] = episode
                after_episode(agent, episode)
    return [score(name, [found[one] for one in seeds]) for name, found in flown.items()]


def fly_share(share: Share) -> list[Episode]:
    """Fly the episodes of a share, in their order."""
    env = make_environment(share.environment)
    baselines, policies = ([share.agent], []) if share.policy is None else ([], [share.policy])
    (agent,) = make_agents(baselines, policies, env, seed=share.seed).values()
    flown = [fly_episode(env, agent, seed=seed, track=share.track) for seed in share.seeds]
    env.close()
    return flown


def _parts(seeds: range, *, whole: bool) -> list[range]:
    """Return the seeds in parts; an agent that draws on from one episode to the next flies all of them."""
    size = len(seeds) if whole else EPISODES_OF_A_SHARE
    return [seeds[first : first + size] for first in range(0, len(seeds), size)]
