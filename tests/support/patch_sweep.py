"""Every numeric text of many robots edited and edited back: patched beside a full run.

`python -m tests.support.patch_sweep FOLDER [--every N] [--part I/N]` goes through all files below a
folder that our evaluator expands without arguments, and prints a line for each and a sum.
"""

from __future__ import annotations

import argparse
import sys
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from studio.description.values import ReadPolicy
from studio.errors import EditError
from tests.support.corpus_files import package_folders
from tests.support.patched import SideBySide

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping


@dataclass
class Sweep:
    """What came of the edits of one or more files."""

    sites: int = 0
    patched: int = 0
    full: int = 0
    wrong: list[str] = field(default_factory=list[str])

    def add(self, other: Sweep) -> None:
        """Count another one's, too."""
        self.sites += other.sites
        self.patched += other.patched
        self.full += other.full
        self.wrong += other.wrong

    def __str__(self) -> str:
        counts = f"{self.sites} sites, {self.patched} patched, {self.full} full"
        return f"{counts}, {len(self.wrong)} wrong"


def sweep(
    file: Path,
    policy: ReadPolicy,
    arguments: Mapping[str, str] | None = None,
    every: int = 1,
    offset: int = 0,
) -> Sweep:
    """Edit every numeric text that a run reads, each to a value near its own, and back."""
    done = Sweep()
    side = SideBySide(file, policy, arguments)
    numeric = [name for name in side.told.sites if side.told.site(name).number is not None]
    for name in numeric[offset::every]:
        wrong = _edited_and_back(side, name)
        done.sites += 1
        if wrong:
            done.wrong.append(wrong)
            side = SideBySide(file, policy, arguments)
    done.patched, done.full = side.patched, side.ran
    return done


def _edited_and_back(side: SideBySide, name: str) -> str:
    """What the patched and the full state disagree about, if they do."""
    before = side.told.site(name).text
    for text in (_near(side.told.site(name).number or 0), before):
        try:
            side.edit(name, text)
        except EditError:
            return ""
        found = side.differences()
        if found:
            return f"{name} = {text}\n" + "\n".join(found[:3])
    return ""


def _near(value: float) -> str:
    return f"{value * 1.0625 + 0.001:.6f}"


def robots(folder: Path) -> Iterator[Path]:
    """Whatever may be a robot below a folder."""
    for path in sorted((*folder.rglob("*.xacro"), *folder.rglob("*.urdf"))):
        if path.is_file() and b"<robot" in path.read_bytes():
            yield path


def _say(*lines: str) -> None:
    sys.stdout.write("".join(f"{line}\n" for line in lines))
    sys.stdout.flush()


def main() -> None:
    """Sweep a folder."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--every", type=int, default=1)
    parser.add_argument("--part", default="0/1")
    options = parser.parse_args()
    index, parts = map(int, options.part.split("/"))
    folder = options.folder.resolve()
    policy = ReadPolicy((str(folder),), package_folders(folder), {})
    total, files = Sweep(), 0
    for file in list(robots(folder))[index::parts]:
        try:
            done = sweep(file, policy, every=options.every)
        except AssertionError:
            continue  # no robot without arguments
        files += 1
        total.add(done)
        _say(f"{file.relative_to(folder)}: {done}", *done.wrong)
    _say(f"{files} files: {total}")
    sys.exit(bool(total.wrong))


if __name__ == "__main__":
    main()
