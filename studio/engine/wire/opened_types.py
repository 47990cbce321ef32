"""Types that opened packages define: known on the wire as soon as the robot beside them is open."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from studio.errors import PackageError, StudioError
from studio.packages.index import Standing
from studio.problems import Problem, Severity

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from studio.packages.workspace import Location
    from studio.ros.types.library import TypeLibrary

CODE: Final = "unusable-interfaces"
_KINDS: Final = ("msg", "srv", "action")


def take_types(location: Location, library: TypeLibrary | None = None) -> tuple[Problem, ...]:
    """Take up the messages, services and actions of the opened packages; in a thread.

    Args:
        location: Whose packages; those of an installation are left alone.
        library: Of the wire; that which all nodes of the process share, if none is given.

    Returns:
        A warning for each package whose texts cannot be used.
    """
    found: list[Problem] = []
    for name, folder in _packages(location):
        from studio.ros.messages.shared import shared_types  # noqa: PLC0415 - takes its time
        from studio.ros.types.folders import texts_of_package  # noqa: PLC0415

        try:
            taken = library or shared_types()
            texts = texts_of_package(folder, name)
            # Only what is new: whoever holds a class of a type that is taken again loses it.
            news = {one: text for one, text in texts.items() if taken.text_of(one) != text}
            if news:
                taken.add_texts(news)
        except StudioError as error:
            found.append(_problem(name, error))
    return tuple(found)


def _packages(location: Location) -> Iterator[tuple[str, Path]]:
    """Opened packages with a folder of types."""
    for one in location.index.packages:
        if one.standing is Standing.OPENED and any((one.folder / kind).is_dir() for kind in _KINDS):
            try:
                yield one.name, location.served.resolve(one.folder)
            except PackageError:  # beside what is served
                continue


def _problem(package: str, error: StudioError) -> Problem:
    sentence = f"The types of the package {package} are not known on the wire: {error}"
    return Problem(Severity.WARNING, CODE, sentence)
