"""Displays of the user's own: a Python file each, run in a process beside the studio."""

from __future__ import annotations
