"""Which file includes which, told from the texts alone: nothing is expanded."""

from __future__ import annotations

import os
import re
from collections import defaultdict
from pathlib import Path
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from studio.packages.outline import Outline

_FIND: Final = re.compile(r"(?:file://)?\$\(find\s+([\w.-]+)\s*\)/(.*)|package://([\w.-]+)/(.*)")


class Includes:
    """The include graph among some files, as far as it can be told."""

    def __init__(
        self, outlines: Mapping[Path, Outline], packages: Mapping[Path, tuple[str, Path | None]]
    ) -> None:
        self._outlines = outlines
        self._folders = {name: folder for name, folder in packages.values() if name and folder}
        self._by_name: dict[str, list[Path]] = defaultdict(list)
        for path in outlines:
            self._by_name[path.name].append(path)
        self._included: dict[Path, list[Path]] = {}
        """What each file includes of these files."""
        self._unknown: set[Path] = set()
        """Files that include something that is not among these."""
        self._includers: dict[Path, list[Path]] = defaultdict(list)
        for path, outline in outlines.items():
            self._link(path, outline.includes)

    def includers(self, path: Path) -> list[Path]:
        """The files that include this one, other than itself."""
        return self._includers.get(path, [])

    def bring_content(self, path: Path) -> bool:
        """Whether what a file includes, over any number of steps, holds a link or a macro call.

        What cannot be looked at is trusted to, when the file has a name of its own.
        """
        waiting, seen = list(self._included[path]), {path}
        if path in self._unknown and self._outlines[path].name:
            return True
        while waiting:
            one = waiting.pop()
            if self._outlines[one].has_content:
                return True
            if one not in seen:
                seen.add(one)
                waiting += self._included[one]
        return False

    def _link(self, path: Path, includes: Iterable[str]) -> None:
        self._included[path] = []
        for written in includes:
            targets = [one for one in self._targets(path, written) if one != path]
            if not targets:
                self._unknown.add(path)
            self._included[path] += targets
            for target in targets:
                self._includers[target].append(path)

    def _targets(self, path: Path, written: str) -> list[Path]:
        """The files that a written name may mean; several when only its end is certain."""
        found = _FIND.fullmatch(written.strip())
        if found:
            folder, inside = self._folders.get(found[1] or found[3]), found[2] or found[4]
            exact = Path(os.path.normpath(folder / inside)) if folder else None
        else:
            inside = written.strip()
            exact = Path(os.path.normpath(path.parent / inside))
        if exact is not None and exact in self._outlines:
            return [exact]
        return self._by_ending(inside) if "$" in written else []

    def _by_ending(self, inside: str) -> list[Path]:
        """Those whose path ends with what stands behind the last substitution."""
        ending = re.split(r"[})]", inside)[-1]
        if not ending.startswith("/") or "*" in ending:
            return []
        return [one for one in self._by_name[Path(ending).name] if one.as_posix().endswith(ending)]
