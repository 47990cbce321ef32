"""Runs a user's program: `python -m studio.importable [--strict] entry|file ...`."""

from __future__ import annotations

import sys

from studio.importable.running import main

if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
