"""Types that opened packages define: known on the wire as soon as the robot beside them is open."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from studio.errors import PackageError, StudioError
from studio.packages.index import Rank
from studio.packages.manifest import FILE_NAME
from studio.problems import Place, Problem, Severity

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from studio.errors import InterfaceTextError
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
        A warning for each file that defines no type, and for each package that cannot be read.
    """
    found: list[Problem] = []
    for name, folder in _packages(location):
        from studio.ros.messages import shared_types  # noqa: PLC0415 - takes its time
        from studio.ros.types.files import texts_of_package  # noqa: PLC0415

        try:
            # Only what is new: a class kept elsewhere goes stale when its type is added again.
            faults = (library or shared_types()).add_sound_texts(texts_of_package(folder, name))
        except StudioError as error:
            found.append(_problem(name, folder, error))
        else:
            found += [_text_problem(fault) for fault in faults.values()]
    return tuple(found)


def _packages(location: Location) -> Iterator[tuple[str, Path]]:
    """Opened packages with a folder of types."""
    for one in location.index.packages:
        if one.rank is Rank.OPENED and any((one.folder / kind).is_dir() for kind in _KINDS):
            try:
                yield one.name, location.served.resolve(one.folder)
            except PackageError:  # beside what is served
                continue


def _problem(package: str, folder: Path, error: StudioError) -> Problem:
    sentence = f"The types of the package {package} are not known on the wire: {error}"
    return Problem(Severity.WARNING, CODE, sentence, Place(str(folder / FILE_NAME)))


def _text_problem(fault: InterfaceTextError) -> Problem:
    sentence = f"This type is not known on the wire: {fault.reason}."
    return Problem(Severity.WARNING, CODE, sentence, Place(fault.name, fault.line or 0))
