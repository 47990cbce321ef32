"""Arguments that real files can be launched with: every switch, every choice, some at random."""

from __future__ import annotations

import random
from pathlib import Path
from typing import TYPE_CHECKING

from studio.description.evaluator.substitution import find_package
from studio.description.faults import Fault
from studio.description.sites.launch_arguments import LaunchArgument, launch_arguments
from studio.description.values import WidgetKind
from studio.errors import UnreadableFileError

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from studio.description.values import ReadPolicy

CHOICES_TRIED = 6
COMBINATIONS = 6


def launches(file: str, policy: ReadPolicy) -> Iterator[dict[str, str]]:
    """Arguments for a file: those it needs, then each of its options, then several at once."""
    found = launch_arguments(file, {}, _Disk(policy.packages))
    needed = {one.name: _options(one)[0] for one in found if one.default is None}
    if needed:
        yield needed
    for one in found:
        for option in _options(one)[:CHOICES_TRIED]:
            if option != one.default:
                yield {**needed, one.name: option}
    dice = random.Random(file)
    for _ in range(COMBINATIONS if found else 0):
        some = (one for one in found if dice.random() < 0.5)
        yield {**needed, **{one.name: dice.choice(_options(one)) for one in some}}


def _options(argument: LaunchArgument) -> tuple[str, ...]:
    if argument.widget.kind is WidgetKind.SWITCH:
        return ("true", "false")
    return argument.widget.choices or (argument.default or "x", "1", "0.5")


class _Disk:
    """The files and packages of a policy, as `launch_arguments` asks for them."""

    def __init__(self, packages: Mapping[str, tuple[str, ...]]) -> None:
        self._packages = dict(packages)

    def read(self, path: str) -> bytes:
        try:
            return Path(path).read_bytes()
        except OSError:
            raise UnreadableFileError(path, "is not there.") from None

    def find(self, package: str, asking_file: str) -> str | None:
        try:
            return find_package(self._packages, package, asking_file)
        except Fault:
            return None

    def names(self, folder: str) -> tuple[str, ...]:
        if not Path(folder).is_dir():
            return ()
        return tuple(one.name for one in sorted(Path(folder).iterdir()))

    def exists(self, path: str) -> bool:
        return Path(path).exists()

    def is_folder(self, path: str) -> bool:
        return Path(path).is_dir()
