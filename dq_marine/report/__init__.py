"""Error against run time, stability and cost of each term, measured by one command: `dq-marine report`."""
