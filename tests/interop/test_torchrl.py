"""TorchRL takes the environments as they are, and reads all of their infos."""

import gymnasium as gym
import pytest

import dq_marine  # noqa: F401 - registers

pytestmark = pytest.mark.filterwarnings("ignore")  # what TorchRL warns of is not ours
torch = pytest.importorskip("torch")
pytest.importorskip("torchrl")

from torchrl.envs import GymEnv, GymWrapper  # noqa: E402
from torchrl.envs.gym_like import default_info_dict_reader  # noqa: E402

ID = "dq_marine/StationKeeping-v0"
INFOS = {
    "position_error", "attitude_error", "is_success", "refused", "current_ned",
    "reward/position", "reward/precision", "reward/attitude", "reward/effort",
}  # fmt: skip
LENGTH, STEPS = 7, 16


def assert_rollout_has_infos(env):
    """A rollout over ends of episodes, with each number of the infos at each step."""
    rollout = env.rollout(STEPS, break_when_any_done=False)
    for part in (rollout, rollout["next"]):
        assert set(part.keys()) >= INFOS
        assert all(torch.isfinite(part[name].double()).all() for name in INFOS)
    assert rollout["next", "truncated"].sum() >= STEPS // (LENGTH + 1)
    distance = rollout["next", "observation"][..., :3].double().norm(dim=-1)
    torch.testing.assert_close(
        rollout["next", "position_error"].reshape(distance.shape), distance, rtol=1e-5, atol=1e-5
    )
    env.close()


def test_a_single_environment_by_its_id():
    env = GymEnv(ID, max_episode_steps=LENGTH)
    assert_rollout_has_infos(env.auto_register_info_dict())


def test_infos_that_are_asked_for_by_name():
    env = GymWrapper(gym.make(ID, max_episode_steps=LENGTH))
    env.set_info_dict_reader(default_info_dict_reader(sorted(INFOS)))
    env.reset()
    assert set(env.rollout(3)["next"].keys()) >= INFOS
    env.close()


def test_the_vector_environment():
    """Without autoreset, which TorchRL prefers; with "SameStep" it reads the last observation, and no other infos."""
    envs = gym.make_vec(ID, num_envs=3, max_episode_steps=LENGTH, autoreset_mode="Disabled")
    assert_rollout_has_infos(GymWrapper(envs).auto_register_info_dict())


def test_several_by_their_id():
    """`num_envs` has TorchRL make worker processes; the id names the module that they must import."""
    env = GymEnv(f"dq_marine:{ID}", num_envs=2, max_episode_steps=LENGTH)
    assert_rollout_has_infos(env)  # it has registered the infos by itself
