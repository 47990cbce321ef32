"""The `studio` command: parses the command line, calls the rooms, returns an exit code."""

from studio.cli.main import main

__all__ = ["main"]
