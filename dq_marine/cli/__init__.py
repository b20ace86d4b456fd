"""The command `dq-marine`."""
