"""What a person flies is read back from Minari's datasets as it was flown, one dataset for each environment."""

from pathlib import Path

from support.minari_child import needs_minari, printed_by

FLOWN = """
import os
import sys
from pathlib import Path

import minari
import numpy as np
from support.scripted_page import ScriptedPage

import dq_marine
from dq_marine.agents.controllers.baselines import ZeroAgent
from dq_marine.agents.environments import DEFAULT_ENVIRONMENT, with_keywords
from dq_marine.agents.evaluation.flight import FlightPlan, Outputs
from dq_marine.agents.interactive import flying
from dq_marine.agents.interactive.controls import AGENT, HOLD, PULL, QUIT, RESET, SEED, STICK
from dq_marine.agents.interactive.next_episode import VEHICLE
from dq_marine.agents.interactive.recording import Recorder
from dq_marine.viewer.controls import Event
from dq_marine.viewer.pacing import RealTimePacer

folder = Path(sys.argv[1])
RealTimePacer.wait_until = lambda self, time: None
sway = Event(STICK, (0.0, 1.0, 0.0, 0.0, 0.0, 0.0))
script = [
    [Event(HOLD, False), sway], [], [], [Event(AGENT, "zero")], [],
    [Event(SEED, 9), Event(RESET)], [Event(PULL, ((0.1, 0.0, 0.0), (9.0, 0.0, 5.0)))], [Event(PULL, None)],
    [Event(RESET)],
    [Event(RESET), Event(VEHICLE, "bluerov2")], [],
]
page = ScriptedPage(script)
flying.open_page = lambda shape, title: page
plan = FlightPlan(with_keywords(DEFAULT_ENVIRONMENT, current=0.0), seconds=3.0, seed=4)
offer = lambda env: {"zero": ZeroAgent(env.action_space.shape[0])}
with Recorder(folder) as recorder:
    last = flying.fly_interactively(
        plan, offer, Outputs(), title="", teleoperated=True, recorder=recorder
    )
print(recorder.written)
assert recorder.written == {
    "dq_marine/StationKeeping/BlueROV2-Heavy-v0": 2, "dq_marine/StationKeeping/BlueROV2-v0": 1
}, recorder.written
assert os.environ["MINARI_DATASETS_PATH"] == "elsewhere"
assert not [one for one in folder.iterdir() if one.name.startswith(".")]

os.environ["MINARI_DATASETS_PATH"] = str(folder)
assert set(minari.list_local_datasets()) == set(recorder.written)
heavy, other = (minari.load_dataset(name) for name in sorted(recorder.written))
first, second = heavy.iterate_episodes()
assert [len(one.rewards) for one in (first, second)] == [5, 2]
assert first.infos["by_person"].tolist() == [True] * 4 + [False] * 2
# One flag for each instant, of the step that led to it; the first of a reset.
assert not first.infos["pushed"].any()
assert second.infos["pushed"].tolist() == [False, True, False]
np.testing.assert_array_equal(first.actions[:, 1], [1.0, 1.0, 1.0, 0.0, 0.0])
assert bool(second.truncations[-1]) and not bool(second.terminations[-1])

# The environment that comes back from the dataset flies the same way again.
env = heavy.recover_environment()
assert env.unwrapped.vehicle.name == "BlueROV2 Heavy"
observation, _ = env.reset(seed=4)
for period, action in enumerate(first.actions):
    np.testing.assert_array_equal(first.observations[period], observation)
    observation, reward, *_ = env.step(action)
    assert reward == first.rewards[period]
(only,) = other.iterate_episodes()
np.testing.assert_array_equal(only.actions, last.actions.astype(np.float32))

# Another flight goes beside these.
page.script[:] = [[], []]
with Recorder(folder) as recorder:
    flying.fly_interactively(plan, offer, Outputs(), title="", recorder=recorder)
assert list(recorder.written) == ["dq_marine/StationKeeping/BlueROV2-Heavy-v1"], recorder.written
page.script[:] = [[Event(QUIT)]]
with Recorder(folder) as recorder:
    flying.fly_interactively(plan, offer, Outputs(), title="", recorder=recorder)
assert recorder.written == {}  # nothing was flown
assert len(minari.list_local_datasets()) == 3
print("as it was flown")
"""


@needs_minari
def test_what_a_person_flew_is_read_back(tmp_path: Path) -> None:
    assert "as it was flown" in printed_by(FLOWN, str(tmp_path / "flights"), datasets="elsewhere")
