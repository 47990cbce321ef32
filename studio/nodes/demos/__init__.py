"""The systems of the course, as real nodes: each runs in a process of its own."""
