"""`make bench`: each figure beside its peer, measured interleaved in the same run."""
