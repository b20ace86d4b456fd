"""A picture of a scenario: the baseline controller under way in it, with the way it came."""

from __future__ import annotations

import io

from dq_marine.agents.controllers.baselines import controller_for
from dq_marine.agents.environments import marine
from dq_marine.agents.evaluation.episodes import fly_episode
from dq_marine.envs.core.view import shape_of
from dq_marine.envs.scenarios.environment import make_scenario
from dq_marine.envs.scenarios.model import Scenario
from dq_marine.util.extras import extra_needed
from dq_marine.viewer.offscreen import OffscreenViewer

SHARE, FRAMES = 0.45, 9
"""How far on in its episode the vehicle is drawn, and of how many moments its trail is."""

COLOURS, REFINEMENTS = 96, 3
"""How many colours there are, and how often they are moved to the mean of what they stand for: without it small bright
things, such as the arrow to the bow, take the colour of what is larger."""


def scenario_picture(scenario: Scenario) -> bytes:
    """Return a picture as a PNG file of 640 x 480 pixels and some 25 kB.

    Raises:
        MissingDependencyError: meshcat, Pillow or a Chromium is not installed.
        InvalidInputError: no controller of this package flies the scenario's task.
    """
    with extra_needed("a picture", "render"):
        from PIL import Image
    env = make_scenario(scenario)
    agent = controller_for(env)
    inner = marine(env)
    whole = fly_episode(env, agent, seed=scenario.seed, options=dict(scenario.reset))
    last = int(SHARE * len(whole.rewards))
    drawn = {last * number // (FRAMES - 1) for number in range(FRAMES)}
    observation, _ = env.reset()
    agent.reset(env)
    with OffscreenViewer(shape_of(inner.vehicle), smooth=True) as viewer:
        for period in range(last + 1):
            if period in drawn:
                pixels = viewer.render(inner.snapshot())
            if period < last:
                observation = env.step(agent.act(observation))[0]
    file = io.BytesIO()
    picture = Image.fromarray(pixels)
    picture.quantize(COLOURS, kmeans=REFINEMENTS, dither=Image.Dither.NONE).save(file, "png", optimize=True)
    return file.getvalue()
