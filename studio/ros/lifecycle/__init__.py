"""Managed nodes: transitions in, states and events out, on both ends."""
