"""The `studio` command: words of a command line in, the work of a room done, an exit code out."""

from studio.cli.main import main

__all__ = ["main"]
