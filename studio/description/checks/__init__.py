"""A finished run in, findings out: what its texts hardly mean as they say it, and what mends it."""
