"""What planning and running have in common: visiting actions, arguments, includes, packages."""

from __future__ import annotations

import os
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, Final, cast

from studio.errors import LaunchError, LaunchFileError, TooManyActionsError
from studio.launch.plan import Where
from studio.launch.shares import Shares
from studio.launch.vocabulary.reading import description_of, sentence_of
from studio.launch.vocabulary.texts import is_unknown, perform

if TYPE_CHECKING:
    from pathlib import Path

    from studio.launch.vocabulary.actions import DeclareLaunchArgument
    from studio.launch.vocabulary.context import LaunchContext
    from studio.packages.index import PackageIndex

INCLUDES_MAX: Final = 400
DEPTH_MAX: Final = 40
VISITS_MAX: Final = 100_000


class BaseHost:
    """Visits what a launch file describes; how a thing is started or noted is the subclass's."""

    plans = False

    def __init__(self, index: PackageIndex, asking: Path) -> None:
        self.index, self._shares = index, Shares(index, asking)
        self._files: list[str] = []
        self._includes = 0
        self._visits = 0

    def walk(self, entities: Iterable[Any], context: LaunchContext) -> None:
        """Visit each, in their order."""
        for entity in entities:
            self.visit(entity, context)

    def visit(self, entity: Any, context: LaunchContext) -> None:
        """Visit one, then what it gives.

        Raises:
            TooManyActionsError: There are too many.
            LaunchError: It is nothing that a launch description may hold.
        """
        self._visits += 1
        if self._visits > VISITS_MAX:
            raise TooManyActionsError(f"there are more than {VISITS_MAX} actions: start fewer")
        if entity is None:
            return
        if not hasattr(entity, "visit"):
            raise LaunchError(_no_action(entity))
        inner = entity.visit(context)
        if inner is not None:
            self.walk(_listed(inner), context)

    def share_of(self, package: str) -> Path:
        """Return a package's folder of shared files, laid out as its installation would be."""
        return self._shares.share_of(package)

    def prefix_of(self, package: str) -> Path:
        """Return the folder that a package is, or would be, installed into."""
        share = self._shares.share_of(package)
        return share.parent.parent if share.parent.name == "share" else share

    def read_include(self, source: Any, context: LaunchContext) -> tuple[str, Any]:
        """Return the path of a source, and what it describes.

        Raises:
            LaunchFileError: It cannot be read; or it includes itself without end.
        """
        path = ""
        if source.launch_description is None:
            path = os.path.abspath(perform(context, source.location))  # noqa: PTH100
        self._includes += 1
        if path and self._files.count(path) > 3:
            raise LaunchFileError(path, 0, "it includes itself without end: give that a condition")
        if self._includes > INCLUDES_MAX or len(self._files) > DEPTH_MAX:
            reason = f"more than {INCLUDES_MAX} includes, or {DEPTH_MAX} within each other"
            raise LaunchFileError(path, 0, reason)
        return path, description_of(source, context)

    def walk_included(self, path: str, description: Any, context: LaunchContext) -> None:
        """Visit what a file describes, with it as the current file."""
        file = path or context.current_file
        self._files.append(file)
        try:
            with context.in_file(file):
                self.visit(description, context)
        finally:
            self._files.pop()

    def value_of_argument(
        self, argument: DeclareLaunchArgument, context: LaunchContext
    ) -> str | None:
        """Return the value of a declared argument, its default where none is given."""
        given = context.launch_configurations.get(argument.name)
        if given is not None:
            return str(given)
        if argument.default_value is None:
            return None
        return perform(context, argument.default_value)

    def set_environment(self, name: str, value: str | None, where: Where) -> None:
        """Set a variable of this process, which those that it starts inherit."""
        del where
        if value is None:
            os.environ.pop(name, None)
        else:
            os.environ[name] = value

    def note_file(self, path: str) -> None:
        """Take a file that was read."""


def choice_fault(argument: DeclareLaunchArgument, value: str) -> str:
    """Return what is wrong with a value by the argument's choices; empty: nothing."""
    if argument.choices is None or value in argument.choices or is_unknown(value):
        return ""
    return f"{argument.name} is '{value}': it must be one of {', '.join(argument.choices)}"


def action_where(entity: Any) -> Where:
    """Return the line that made an action."""
    where = getattr(entity, "where", None)
    return where if isinstance(where, Where) else Where()


def fault_at(error: Exception, entity: Any) -> LaunchFileError:
    """Return what went wrong while an action was visited, with a line."""
    if isinstance(error, LaunchFileError):
        where = action_where(entity)
        if error.path or not where.file:
            return error
        return LaunchFileError(where.file, where.line, error.reason)
    from studio.launch.vocabulary.places import where_raised  # noqa: PLC0415

    raised = where_raised(error.__traceback__)
    where = raised if raised.line else action_where(entity)
    return LaunchFileError(where.file, where.line, sentence_of(error))


def _listed(inner: Any) -> Iterable[Any]:
    if isinstance(inner, Iterable) and not isinstance(inner, str):
        return cast("Iterable[Any]", inner)
    return [inner]


def _no_action(entity: Any) -> str:
    kind = type(entity).__name__
    if isinstance(entity, list | tuple):
        return f"a launch description holds a {kind}: put its actions in one by one, by *"
    return f"a launch description holds {kind}, which is no action: leave it out"
