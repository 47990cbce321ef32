"""Writes an edit of a package to the disk, for the command line: all of it, or nothing."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from studio.errors import NotMadeError, PackageError
from studio.files import is_there, write_whole
from studio.packages.sources.spans import with_replacements

if TYPE_CHECKING:
    from studio.packages.edits.package_edit import PackageEdit
    from studio.packages.roots import ServedRoots


def write_edit(edit: PackageEdit, roots: ServedRoots) -> tuple[Path, ...]:
    """Write new and changed files below the served folders; return them, the new ones first.

    Raises:
        NotMadeError: A new file is there already, a changed one is not as it was, or the system
            refused; what was written until then is taken back.
    """
    changed = _changed(edit, roots)
    before = {path: roots.read(path) for path in changed}
    made: list[Path] = []
    done: list[Path] = []
    path = Path(edit.opened or ".")
    try:
        for new in edit.new_files:
            path = roots.resolve(new.file)
            if is_there(path):
                raise NotMadeError(str(path), "it is there already: choose another name.")
            path.parent.mkdir(parents=True, exist_ok=True)
            with path.open("xb") as opened:
                made.append(path)
                opened.write(new.text.encode())
        for path, data in changed.items():
            write_whole(path, data, mode=path.stat().st_mode & 0o777)
            done.append(path)
    except (OSError, PackageError) as error:
        for one in made:
            one.unlink(missing_ok=True)
        for one in done:
            write_whole(one, before[one])
        if isinstance(error, OSError):
            reason = f"the system refused ({error.strerror or type(error).__name__})."
            raise NotMadeError(str(path), reason) from error
        raise
    return (*made, *done)


def _changed(edit: PackageEdit, roots: ServedRoots) -> dict[Path, bytes]:
    """Return the new bytes of each file that changes."""
    found: dict[Path, bytes] = {}
    for file in dict.fromkeys(one.file for one in edit.edits):
        path = roots.resolve(file)
        changes = [one for one in edit.edits if one.file == file]
        try:
            found[path] = with_replacements(roots.read(path), changes)
        except ValueError:
            raise NotMadeError(file, "it has changed meanwhile: try again.") from None
    return found
