"""Scenarios: episodes that can be repeated, by name. The files beside this one have twenty for each task.

A file has the id of its task, and a table for each scenario:

    task = "dq_marine/StationKeeping-v0"

    [[scenario]]
    name = "cross_current"                      # in snake case
    description = "One line that says what is hard about it."
    seed = 3                                    # 0 if nothing is said
    keywords = { current = [0.0, 0.3, 0.0] }    # of gym.make: vehicle, level, current, weather, sensors, ...
    reset = { position = [2.0, 0.0, 5.0] }      # options of reset: position, quaternion, velocity, current,
                                                # and the task's own, such as goal_position

What keywords and options do not fix, the seed does: obstacles, paths, other vessels, the noise of sensors. An episode
follows from keywords, options, seed and actions bit for bit. Many tasks have no options of their own, so the seed
alone says where their goals are.

Files are found by walking the folder: a new task needs one file here, and nothing else names it.
"""
