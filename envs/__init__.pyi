"""The public names of dq_marine.envs. Each line makes a name public; `dq_marine.util.lazy_names` reads them here."""

from dq_marine.envs.core.definition import EpisodeContext as EpisodeContext
from dq_marine.envs.core.definition import Goal as Goal
from dq_marine.envs.core.definition import Observed as Observed
from dq_marine.envs.core.definition import TaskDefinition as TaskDefinition
from dq_marine.envs.core.goal_env import GoalMarineEnv as GoalMarineEnv
from dq_marine.envs.core.marine_env import MarineEnv as MarineEnv
from dq_marine.envs.core.module_task import define_task as define_task
from dq_marine.envs.core.perturbations import PERTURBATIONS as PERTURBATIONS
from dq_marine.envs.core.perturbations import Perturbation as Perturbation
from dq_marine.envs.core.registry import register_task as register_task
from dq_marine.envs.core.registry import registered_tasks as registered_tasks
from dq_marine.envs.core.registry import task_named as task_named
from dq_marine.envs.core.registry import tasks_suiting as tasks_suiting
from dq_marine.envs.core.registry import unregister_task as unregister_task
from dq_marine.envs.multi.parallel import MarineParallelEnv as MarineParallelEnv
from dq_marine.envs.multi.parallel import parallel_env as parallel_env
from dq_marine.envs.registration import register_environments as register_environments
from dq_marine.envs.scenarios.environment import ScenarioStart as ScenarioStart
from dq_marine.envs.scenarios.environment import make_scenario as make_scenario
from dq_marine.envs.scenarios.files import load_scenario as load_scenario
from dq_marine.envs.scenarios.files import read_scenarios as read_scenarios
from dq_marine.envs.scenarios.files import scenario_names as scenario_names
from dq_marine.envs.scenarios.files import scenarios_of as scenarios_of
from dq_marine.envs.scenarios.model import Scenario as Scenario
from dq_marine.envs.vector.vector_env import MarineVectorEnv as MarineVectorEnv
