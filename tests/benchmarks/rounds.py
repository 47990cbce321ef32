"""Figures of rounds: a small file for each in `results/`, and what the last one had beside ours.

`python -m tests.benchmarks NAME ... --keep ROUND` writes the figures of this run as those of a
round; without it they are only printed, each beside that of the last round.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Final

from tests.benchmarks.report import NOTED, VERDICTS, say

if TYPE_CHECKING:
    from collections.abc import Mapping

FOLDER: Final = Path(__file__).resolve().parent / "results"
_HEAD: Final = (
    "# Figures of one round, `what: figure`; see rounds.py. Machines differ: trust ratios."
)


def figures() -> dict[str, str]:
    """Return what this run measured of what was asked, and noted beside it."""
    return {one.what: one.got for one in VERDICTS} | NOTED


def last_figures() -> dict[str, tuple[str, str]]:
    """Return the newest figure that was kept of each thing, with the name of its round."""
    return {
        what: (path.stem, figure)
        for path in sorted(FOLDER.glob("*.txt"))
        for what, figure in read(path).items()
    }


def read(path: Path) -> dict[str, str]:
    """Return the figures of a file."""
    lines = path.read_text(encoding="utf-8").splitlines()
    pairs = (line.rpartition(": ") for line in lines if ": " in line and not line.startswith("#"))
    return {what: figure for what, _, figure in pairs}


def keep(name: str, measured: Mapping[str, str]) -> Path:
    """Write the figures of a round; those that were not measured now stay as they were."""
    FOLDER.mkdir(exist_ok=True)
    path = FOLDER / f"{name}.txt"
    kept = {**(read(path) if path.exists() else {}), **measured}
    lines = [_HEAD, *(f"{what}: {figure}" for what, figure in kept.items())]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


def say_beside_last(measured: Mapping[str, str]) -> None:
    """Print each figure beside that of the last round that has it."""
    before = last_figures()
    known = {what: figure for what, figure in measured.items() if what in before}
    if not known:
        return
    say("\n[beside the last rounds]")
    for what, figure in known.items():
        name, other = before[what]
        say(f"  {what:<64}{figure:>16}   round {name} {other:>16}")
