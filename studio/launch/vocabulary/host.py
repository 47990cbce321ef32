"""Host: who plans or runs what a launch file says."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from studio.launch.plan import Where
    from studio.launch.vocabulary.context import LaunchContext
    from studio.launch.vocabulary.requests import Later, Request


class Host(Protocol):
    """What the vocabulary needs of the planner, or of the runner."""

    @property
    def plans(self) -> bool:
        """Whether nothing is to be started."""
        ...

    def walk(self, entities: Iterable[Any], context: LaunchContext) -> None:
        """Visit each, in their order."""

    def declare(self, argument: Any, context: LaunchContext) -> None:
        """Take a declared argument: give it its value, check its choices."""

    def start(self, request: Request, context: LaunchContext) -> None:
        """Start a node or command, or note it."""

    def later(self, later: Later, context: LaunchContext) -> Any:
        """Keep what is to be done when something happens; gives a handle for `forget`."""

    def forget(self, handle: Any) -> None:
        """Do it no more."""

    def emit(self, event: Any, context: LaunchContext) -> None:
        """Have an event happen."""

    def include(self, source: Any, given: dict[str, str], context: LaunchContext) -> None:
        """Read another launch file and visit what it describes."""

    def log(self, level: str, text: str, where: Where) -> None:
        """Take a line of the log."""

    def set_environment(self, name: str, value: str | None, where: Where) -> None:
        """Set a variable, or unset it by None."""

    def output_of(self, line: str, on_stderr: str, where: Where) -> str:
        """Return what a command prints.

        Raises:
            SubstitutionFailure: It cannot be run, or failed.
        """
        ...

    def share_of(self, package: str) -> Path:
        """Return a package's folder of shared files.

        Raises:
            PackageNotFoundError: There is no such package.
        """
        ...

    def prefix_of(self, package: str) -> Path:
        """Return the folder that a package is installed into.

        Raises:
            PackageNotFoundError: There is no such package.
        """
        ...

    def note_file(self, path: str) -> None:
        """Take a file that was read, which may be a robot's."""

    def unsupported(self, name: str, sentence: str, where: Where) -> None:
        """Note what is left out."""

    def failed(self, sentence: str, where: Where) -> None:
        """Note what went wrong; the rest goes on."""
