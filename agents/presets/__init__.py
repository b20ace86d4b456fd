"""Presets: TOML files with every number that the agents are tuned by, read by `dq_marine.agents.settings`."""
