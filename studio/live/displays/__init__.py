"""Displays of topics, and frames from TF, drawn live in a document's 3D view."""
