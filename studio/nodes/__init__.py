"""Nodes that every robot needs beside RViz: publishers of its description, joints and links."""
