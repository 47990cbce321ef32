"""Transforms between frames in, any frame's pose in any other out; pure."""
