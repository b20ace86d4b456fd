"""One step: force-free drifts, damped kicks, and the methods that compose them. Plain functions on tuples."""
