"""Several vehicles at once, each with physics of its own and each an agent, by PettingZoo's interface."""
