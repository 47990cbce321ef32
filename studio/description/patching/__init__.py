"""An edit of one text redone in place: what depends on it is evaluated again, and nothing else."""
