"""The order in which a parallel run takes files of tests, each whole: long ones first.

A file shares its router, its studio or its Chromium among its tests: cut over processes, each
would start its own.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    import pytest

LONGEST: Final = (
    "tests/description/test_expanded_as_stock.py",
    "tests/test_packaging.py",
    "tests/test_cli.py",
    "tests/corpus/test_corpus_opens.py",
    "tests/bad_input/test_bad_files.py",
    "tests/server/test_launch.py",
)
"""Minutes each: begun last, one of them would keep all others waiting."""


def in_order(items: Iterable[pytest.Item]) -> list[pytest.Item]:
    """All of them, file by file: long ones, then those of browsers evenly among the others.

    A browser draws with all cores: when each process has one, all are slow.
    """
    files: dict[str, list[pytest.Item]] = {}
    for item in items:
        files.setdefault(item.nodeid.partition("::")[0], []).append(item)
    longest = [path for path in LONGEST if path in files]
    rest = [path for path in files if path not in LONGEST]
    browsers = [path for path in rest if any(map(_needs_browser, files[path]))]
    others = [path for path in rest if path not in set(browsers)]
    order = [*longest, *spread(browsers, others)]
    return [item for path in order for item in files[path]]


def spread(some: Sequence[str], others: Sequence[str]) -> list[str]:
    """Both, each in its order: one of the first, then its part of the others, and so on."""
    parts = max(len(some), 1)
    mixed: list[str] = []
    for number in range(parts):
        mixed += some[number : number + 1]
        mixed += others[len(others) * number // parts : len(others) * (number + 1) // parts]
    return mixed


def _needs_browser(item: pytest.Item) -> bool:
    return item.get_closest_marker("browser") is not None
