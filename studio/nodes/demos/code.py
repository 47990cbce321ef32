"""The source code of a demo, as a lesson shows it."""

from __future__ import annotations

import re
from pathlib import Path

_FOLDER = Path(__file__).parent
_FOR_LINTERS = re.compile(r"  # noqa\b.*$", re.MULTILINE)
_IMPORTED = re.compile(r"^from studio\.nodes\.demos\.(\w+)\.(\w+) import", re.MULTILINE)


def code_of(demo: str) -> dict[str, str]:
    """Return the text of each file of a demo by its name below the folder of the demos.

    Args:
        demo: A name of the table of demos.

    Returns:
        The file with the node first, then the files of a package of demos that it is made of.
    """
    alone = _FOLDER / f"{demo}.py"
    if alone.is_file():
        imported = _IMPORTED.findall(alone.read_text(encoding="utf-8"))
        files = [alone, *(_FOLDER / package / f"{module}.py" for package, module in imported)]
    else:
        parts = sorted((_FOLDER / demo).glob("[!_]*.py"))
        files = sorted(parts, key=lambda part: part.stem != "node")
    return {
        file.relative_to(_FOLDER).as_posix(): _FOR_LINTERS.sub("", file.read_text("utf-8"))
        for file in files
    }
