"""A student in front of two terminals: one in which their nodes run, one in which they look."""

from __future__ import annotations

import contextlib
import os
import shlex
import subprocess
import sys
from typing import TYPE_CHECKING
from unittest import mock

from tests.support.command_line import Ran, started, studio
from tests.support.demos import running
from tests.support.wire import running_router, wait_until

if TYPE_CHECKING:
    from collections.abc import Callable, Generator
    from pathlib import Path

    from tests.support.course_workspaces import Workspace
    from tests.support.demos import RunningDemo


class Student:
    """Works in a workspace, at a router of their own."""

    def __init__(self, endpoint: str, workspace: Workspace, data: Path) -> None:
        self.endpoint = endpoint
        self.workspace = workspace
        self._environment = {
            "ZENOH_CONFIG_OVERRIDE": f'connect/endpoints=["{endpoint}"]',
            "STUDIO_DATA_DIR": str(data),
        }

    @contextlib.contextmanager
    def running(self, line: str) -> Generator[RunningDemo]:
        """Run `run PACKAGE EXECUTABLE ...`, or a file, in a terminal until the block ends."""
        words = shlex.split(line)
        at = 2 if words[1].endswith(".py") else 3
        where = ("--package-path", str(self.workspace.src))
        with started(self.endpoint, *words[:at], *where, *words[at:]) as node:
            yield node

    @contextlib.contextmanager
    def launched(self, line: str) -> Generator[RunningDemo]:
        """Run `launch ...` in a terminal of its own, until the block ends."""
        launch, *words = shlex.split(line)
        code = (
            f"import os; os.chdir({str(self.workspace.folder)!r}); import sys; "
            f"from studio.cli import main; sys.exit(main({[launch, *words]!r}))"
        )
        with running([sys.executable, "-c", code], self.endpoint, warm=False) as process:
            try:
                yield process
            finally:  # by force it could not end what it started
                process.stop()

    def types(self, line: str) -> Ran:
        """Run a line that ends by itself, in the folder of the workspace."""
        with (
            mock.patch.dict(os.environ, self._environment),
            contextlib.chdir(self.workspace.folder),
        ):
            return studio(*shlex.split(line))

    def expands(self, line: str) -> str:
        """What `xacro ...` prints: a process of its own, for it bounds its memory."""
        words = [sys.executable, "-m", "studio", *shlex.split(line)]
        return subprocess.run(
            words,
            cwd=self.workspace.folder,
            env={**os.environ, **self._environment},
            capture_output=True,
            text=True,
            check=True,
        ).stdout

    def sees(self, line: str, said: str) -> None:
        """Run a line until it prints a text: nodes are told of a moment after they begin."""
        self.sees_that(line, lambda ran: said in ran.out)

    def sees_that(self, line: str, is_so: Callable[[Ran], bool]) -> None:
        """Run a line until what it prints is so."""
        last = Ran(0, "", "")

        def look() -> bool:
            nonlocal last
            last = self.types(line)
            return is_so(last)

        try:
            wait_until(line, look, 20.0)
        except AssertionError:
            raise AssertionError(f"`studio {line}` says {last}") from None


@contextlib.contextmanager
def student_in(make: Callable[[Path], Workspace], folder: Path) -> Generator[Student]:
    """A student who has made a workspace below a folder."""
    with running_router() as endpoint:
        yield Student(endpoint, make(folder / "ros2_ws"), folder / "data")
