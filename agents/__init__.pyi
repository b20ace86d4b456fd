"""The public names of dq_marine.agents. Each line makes a name public; `dq_marine.util.lazy_names` reads them here."""

from dq_marine.agents.controllers.baselines import Agent as Agent
from dq_marine.agents.controllers.baselines import RandomAgent as RandomAgent
from dq_marine.agents.controllers.baselines import ZeroAgent as ZeroAgent
from dq_marine.agents.controllers.baselines import make_baseline as make_baseline
from dq_marine.agents.controllers.dp_controller import DPController as DPController
from dq_marine.agents.controllers.mpc import MPCController as MPCController
from dq_marine.agents.controllers.trajectory_control import LQRController as LQRController
from dq_marine.agents.datasets.dataset_folder import DatasetFolder as DatasetFolder
from dq_marine.agents.datasets.recorded_agents import record_agents as record_agents
from dq_marine.agents.deployment.export import export_policy as export_policy
from dq_marine.agents.deployment.onnx_policy import OnnxPolicy as OnnxPolicy
from dq_marine.agents.environments import make_environment as make_environment
from dq_marine.agents.evaluation.episodes import Episode as Episode
from dq_marine.agents.evaluation.episodes import fly_episode as fly_episode
from dq_marine.agents.evaluation.evaluation import Score as Score
from dq_marine.agents.evaluation.evaluation import evaluate as evaluate
from dq_marine.agents.evaluation.evaluation import score_table as score_table
from dq_marine.agents.policies import load_policy as load_policy
from dq_marine.agents.policies import trained_environment as trained_environment
from dq_marine.agents.policy_names import shipped_policies as shipped_policies
from dq_marine.agents.training.trained_policy import TrainedPolicy as TrainedPolicy
from dq_marine.agents.training.training import begin_training as begin_training
from dq_marine.agents.training.training import resume_training as resume_training
from dq_marine.agents.training.vec_env import MarineVecEnv as MarineVecEnv
