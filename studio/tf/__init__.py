"""Transforms between frames in, the pose of any frame in any other out; pure."""
