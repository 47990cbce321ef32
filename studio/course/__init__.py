"""The course: its demo nodes, each run in a process of its own, and its lessons by chapter."""
