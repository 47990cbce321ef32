"""Files, folders and packages that a text names, as far as they may be read."""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import TYPE_CHECKING, Final
from urllib.parse import unquote

from studio.description.evaluator.substitution import find_package
from studio.description.faults import Fault

if TYPE_CHECKING:
    from studio.description.language.reading import Reading

NAMES_LISTED: Final = 1_000
"""Limit for one folder; nobody reads more."""
_TEXT_ENDINGS: Final = frozenset(
    (".xacro", ".urdf", ".xml", ".yaml", ".yml", ".gazebo", ".srdf", ".sdf", ".trans", ".txt")
)
_FIND: Final = re.compile(r"\$\(\s*find\s+([^\s)]+)\s*\)")
_ARG: Final = re.compile(r"\$\(\s*arg\s+([^\s)]+)\s*\)")
_URI: Final = re.compile(r"(?:package|model)://([^/]*)(.*)", re.DOTALL)


def package_folder(reading: Reading, name: str, asking_file: str) -> str:
    """Return the folder of a package; empty when there is none."""
    try:
        return find_package(reading.policy.packages, name, asking_file)
    except Fault:
        return ""


def path_named(reading: Reading, text: str, asking_file: str) -> str | None:
    """Return the path that a text means in a file, existing or not; None when it is not known.

    `$(find)`, `$(arg)`, `package://`, `file://` and paths beside the asking file.
    """
    text = text.strip()
    if reading.trace is not None:
        values = {name: one.value for name, one in reading.trace.arguments.items()}
        text = _ARG.sub(lambda found: values.get(found[1], found[0]), text)
    text = _FIND.sub(lambda found: package_folder(reading, found[1], asking_file), text)
    uri = _URI.fullmatch(text)
    if uri:
        folder = package_folder(reading, uri[1], asking_file)
        return folder + unquote(uri[2]) if folder else None
    text = text.removeprefix("file://")
    if not text or "$" in text or "\0" in text or "://" in text:
        return None
    return text if Path(text).is_absolute() else str(Path(asking_file).parent / text)


def existing(reading: Reading, text: str, asking_file: str) -> str:
    """Return the resolved path that a text means, if it exists and may be read; else empty."""
    path = path_named(reading, text, asking_file)
    real = reading.resolve(path) if path else None
    return real if real and Path(real).exists() else ""


def is_text(path: str) -> bool:
    """Whether a file is one that an editor shows, by its name."""
    return Path(path).suffix.lower() in _TEXT_ENDINGS


def names_in(reading: Reading, folder: str) -> list[tuple[str, bool]]:
    """Return the names in a folder, as (name, is a folder); none when it may not be read."""
    real = reading.resolve(folder)
    if real is None:
        return []
    try:
        with os.scandir(real) as entries:
            found = [
                (one.name, one.is_dir())
                for one, _ in zip(entries, range(NAMES_LISTED), strict=False)
                # Linux allows names that are no text, which no message can carry.
                if not one.name.startswith(".") and "\ufffd" not in _spelled(one.name)
            ]
    except OSError:
        return []
    return sorted(found, key=lambda one: (not one[1], one[0]))


def _spelled(name: str) -> str:
    return os.fsencode(name).decode("utf-8", "replace")
