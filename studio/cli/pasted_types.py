"""Types pasted on standard input: texts, each below a line that says what it defines."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, TextIO

from studio.errors import RosNameError, SettingsError
from studio.ros.names import full_type_name

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

PASTED = "-"
"""What `--interfaces` is given for it."""
CHARACTERS_MAX = 10_000_000
# As recorded files write the types that a type is made of.
_HEAD = re.compile(r"(MSG|SRV|ACTION):[ \t]*(\S+)[ \t]*")
_RULE = re.compile(r"={3,}[ \t]*")


def is_pasted(path: Path) -> bool:
    """Whether a path of `--interfaces` means standard input."""
    return str(path).strip() == PASTED  # a lone dash is shielded by a blank


def pasted_texts(source: TextIO) -> dict[str, str]:
    """Read texts by the full names of their types, to the end of the input.

    Raises:
        SettingsError: A text has no line above it that names its type, or there is too much.
    """
    text = source.read(CHARACTERS_MAX + 1)
    if len(text) > CHARACTERS_MAX:
        raise SettingsError(f"--interfaces -: more than {CHARACTERS_MAX} characters came.")
    found = _parted(text.splitlines())
    if not found:
        raise SettingsError(_refusal("nothing came"))
    return found


def _parted(lines: Iterable[str]) -> dict[str, str]:
    found: dict[str, list[str]] = {}
    current: list[str] | None = None
    for line in lines:
        head = _HEAD.fullmatch(line)
        if head is not None:
            current = found.setdefault(_name(head[2], head[1].lower()), [])
        elif current is not None and not _RULE.fullmatch(line):
            current.append(f"{line}\n")
        elif current is None and line.strip():
            raise SettingsError(_refusal(f'"{line[:40]}" comes first'))
    return {name: "".join(text) for name, text in found.items()}


def _name(given: str, kind: str) -> str:
    try:
        return full_type_name(given, kind)
    except RosNameError as error:
        raise SettingsError(f"--interfaces -: {error}") from None


def _refusal(what: str) -> str:
    return (
        f"--interfaces -: {what}, where a line such as MSG: my_interfaces/Telemetry "
        "is to name what the text below it defines."
    )
