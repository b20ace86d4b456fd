"""Addresses of policies on the Hugging Face Hub, which can be told without its client."""

from __future__ import annotations

SCHEME = "hf://"
"""What an address begins with: hf://OWNER/NAME, or hf://OWNER/NAME@REVISION."""
