"""A search on a cluster: a machine is lost in the middle, and as many trials end as were asked for."""

import threading

import pytest
from support.clusters import alive, two_machines, wait_until
from support.trainings import tiny

from dq_marine.agents.tuning.cluster_trials import on_cluster
from dq_marine.agents.tuning.study_folder import StudyFolder
from dq_marine.agents.tuning.tuning import plan_of, tune
from dq_marine.util.cluster import cluster_workers

pytestmark = [pytest.mark.slow, pytest.mark.filterwarnings("ignore")]  # of Ray's own sockets and warnings

TRIALS = 4


def test_nothing_is_lost_where_a_machine_is_killed_in_a_search(tmp_path):
    plan = plan_of(tiny(tmp_path, "ppo", 512), seed=3)
    folder = StudyFolder(tmp_path / "spread")

    with two_machines() as (cluster, (lost, left)):

        def lose_one():
            wait_until(lambda: bool(list(folder.tensorboard.rglob("events*"))), every=0.01)
            cluster.remove_node(lost, allow_graceful=False)

        losing = threading.Thread(target=lose_one)
        losing.start()
        try:
            way = on_cluster(lambda: cluster_workers(cluster.address, 1))
            spread = tune(folder, plan, trials=TRIALS, way=way)
        finally:
            losing.join()
        with cluster_workers(cluster.address, 1):
            wait_until(lambda: lost.node_id not in alive())
            assert left.node_id in alive()
    assert sorted(one.number for one in spread) == list(range(TRIALS))
    assert all(one.mean_return is not None for one in spread)
    here = tune(StudyFolder(tmp_path / "here"), plan, trials=1)
    assert [one for one in spread if one.number == 0] == here
    assert tune(folder, plan, trials=TRIALS) == spread, "nothing is left to be tried"
