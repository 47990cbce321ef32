"""What `topic pub` says: one message again and again, or those of a file one after another."""

from __future__ import annotations

import re
import sys
import time
from dataclasses import dataclass
from typing import TYPE_CHECKING

from studio.errors import SettingsError

if TYPE_CHECKING:
    import argparse
    from collections.abc import Iterator
    from pathlib import Path

    from studio.ros.types.classes import MessageValue

TEXT_BYTES_MAX = 10_000_000
_BETWEEN = re.compile(r"^---[ \t]*(?:#.*)?$", re.MULTILINE)


@dataclass(frozen=True, slots=True)
class MessageSource:
    """Messages one after another; `count` of them, None without end."""

    messages: Iterator[MessageValue]
    count: int | None = None


def source_of(options: argparse.Namespace, kind: type[MessageValue]) -> MessageSource:
    """Give the messages that a line asks for; the first is made at once: mistakes are told early.

    Raises:
        MessageValueError: A text is no YAML, or no such message.
        SettingsError: There is nothing to read.
    """
    if options.yaml_file is not None:
        path = options.yaml_file.expanduser()
        texts = _documents(_read(path))
        return MessageSource(iter([_message(kind, text, str(path)) for text in texts]), len(texts))
    text = sys.stdin.read(TEXT_BYTES_MAX) if options.stdin else options.values
    source = "standard input" if options.stdin else ""
    return MessageSource(_again_and_again(kind, text, _message(kind, text, source)))


def _again_and_again(
    kind: type[MessageValue], text: str, first: MessageValue
) -> Iterator[MessageValue]:
    """Give one message without end; where it tells the time, that of each moment."""
    has_time = "now" in text or "auto" in text
    while True:
        yield _message(kind, text) if has_time else first


def _message(kind: type[MessageValue], text: str, source: str = "") -> MessageValue:
    from studio.ros.types.convert import from_yaml

    return from_yaml(kind, text, now_ns=time.time_ns(), source=source)


def _documents(text: str) -> list[str]:
    """Part a file into its messages, each with the empty lines that keep its place in the file."""
    found: list[str] = []
    lines_before = 0
    for one in _BETWEEN.split(text):
        if one.strip():
            found.append("\n" * lines_before + one)
        lines_before += one.count("\n")
    if not found:
        raise SettingsError("--yaml-file holds no message: nothing stands between its lines ---.")
    return found


def _read(path: Path) -> str:
    try:
        with path.open("rb") as file:
            data = file.read(TEXT_BYTES_MAX + 1)
    except OSError as error:
        raise SettingsError(f"{path} cannot be read: {error.strerror}.") from error
    if len(data) > TEXT_BYTES_MAX:
        raise SettingsError(f"{path} is larger than {TEXT_BYTES_MAX} bytes.")
    return data.decode(errors="replace")
