"""Lessons: pages of Markdown whose steps have checks."""
