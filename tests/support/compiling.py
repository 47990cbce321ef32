"""The first half minute of a parallel run: each process compiles its part of the tests, for all.

Every process collects every file, in the same order: where nothing is compiled yet, as in a fresh
checkout, each would rewrite the assertions of all files by itself.
"""

from __future__ import annotations

import contextlib
import os
from importlib import import_module
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parents[2]


def import_own_part(config: pytest.Config) -> None:
    """Import, and so compile, what falls to this process; it takes that up when it collects."""
    worker = os.environ.get("PYTEST_XDIST_WORKER", "").removeprefix("gw")
    if not worker or {Path(path).resolve() for path in config.args} != {REPOSITORY / "tests"}:
        return
    for name in part_of(int(worker), int(os.environ["PYTEST_XDIST_WORKER_COUNT"])):
        # What cannot be imported, or is skipped whole, says so when it is collected.
        with contextlib.suppress(Exception, pytest.skip.Exception):
            import_module(name)


def part_of(worker: int, workers: int) -> list[str]:
    """Name the modules of tests of one process, from 0."""
    files = sorted(REPOSITORY.glob("tests/**/test_*.py"))[worker::workers]
    return [".".join(file.relative_to(REPOSITORY).with_suffix("").parts) for file in files]
