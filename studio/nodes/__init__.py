"""Nodes of our own on the wire: what RViz's usual companions do, and the demos of the course."""
