"""Trained policies outside of Stable-Baselines3: exported files, what flies them, model cards, the Hugging Face Hub."""
