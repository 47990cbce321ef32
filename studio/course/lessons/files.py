"""The files that a lesson begins with: written into a folder of the reader's own.

They lie in `files/LESSON` beside the texts, each with `.txt` behind its name: some are broken on
purpose, and no tool of ours is to read them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from studio.errors import LessonError

if TYPE_CHECKING:
    from pathlib import Path

_FOLDER: Final = "files"
_ENDING: Final = ".txt"


def lessons_with_files(course: Path) -> list[str]:
    """Return the names of the lessons of the course that have files, in order."""
    return sorted(one.name for one in (course / _FOLDER).glob("*") if one.is_dir())


def write_files(course: Path, name: str, folder: Path) -> list[Path]:
    """Write the files of a lesson, and return them.

    Args:
        course: Has the lessons of the course.
        name: Of the lesson.
        folder: Is made, and must not be there yet.

    Raises:
        LessonError: The lesson has no files, or the folder cannot be made.
    """
    known = lessons_with_files(course)
    if name not in known:
        raise LessonError(f"No lesson {name[:60]!r} has files: {', '.join(known)} have some.")
    source = course / _FOLDER / name
    written: list[Path] = []
    try:
        folder.mkdir(parents=True)
        for file in sorted(source.rglob(f"*{_ENDING}")):
            path = folder / str(file.relative_to(source)).removesuffix(_ENDING)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(file.read_bytes())
            written.append(path)
    except FileExistsError:
        raise LessonError(
            f"{folder} is there already: remove it, or name another place behind {name}."
        ) from None
    except OSError as error:
        raise LessonError(f"{folder} cannot be written: {error.strerror}.") from error
    return written
