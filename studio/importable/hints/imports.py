"""What was meant by an import that failed: types of another package, and modules that are near."""

from __future__ import annotations

import difflib
import re
import traceback
from typing import Final

from studio.importable.hints.modules import absent_sentence, is_ours, name_sentence
from studio.importable.hints.said import is_users, place_of
from studio.packages.sources.interfaces import KIND_NAMES
from studio.ros.messages import shared_types
from studio.ros.names import KINDS

_MISSING: Final = re.compile(r"cannot import name '(\w+)'")


def import_hint(error: ImportError) -> str | None:
    """Return a sentence about what was imported from where it is not; None: nothing is known.

    Args:
        error: What ended the program.
    """
    found = _statement(error)
    if found is None:
        return None
    at, module, wanted = found
    known = _of_ours(module, wanted) if is_ours(module) else _of_others(module, wanted)
    return f"{at}: {known}" if known else None


def _of_ours(module: str, wanted: list[str]) -> str | None:
    """Look among the modules of rclpy, tf2_ros and the others that the studio makes."""
    return name_sentence(module, wanted) or absent_sentence(module)


def _of_others(module: str, wanted: list[str]) -> str | None:
    """Look among the types first: `from std_msgs.srv import AddTwoInts`."""
    package, _, kind = module.partition(".")
    meant = (_sentence(package, kind, name) for name in wanted)
    known = next(filter(None, meant), None) if kind in KINDS or not kind else None
    return known or absent_sentence(module) or name_sentence(module, wanted)


def _statement(error: ImportError) -> tuple[str, str, list[str]] | None:
    """Return place, module and names of the user's import that failed."""
    users = [
        (frame, line) for frame, line in traceback.walk_tb(error.__traceback__) if is_users(frame)
    ]
    if not users:
        return None
    frame, line = users[-1]
    text = traceback.FrameSummary(frame.f_code.co_filename, line, "").line or ""
    words = text.split("#")[0].replace(",", " ").replace("(", " ").replace(")", " ").split()
    where = place_of(frame.f_code.co_filename, line)
    if words[:1] == ["import"]:
        missing = error.name or ""
        written = next((one for one in words[1:] if one.startswith(missing)), "")
        return (where, written, []) if missing and written else None
    if words[:1] != ["from"] or "import" not in words:
        return None
    at = words.index("import")
    names = [one for one in words[at + 1 :] if one.isidentifier() and one != "as"]
    if missing := _MISSING.match(str(error)):  # of several names, the one that is not there
        names = [missing[1]]
    return where, words[1], names


def _sentence(package: str, kind: str, name: str) -> str | None:
    all_names = shared_types().names()
    if f"{package}/{kind}/{name}" in all_names:
        return None
    same = [one for one in all_names if one.rpartition("/")[2] == name]
    if not same and kind in KINDS:
        same = [
            f"{package}/{kind}/{one}"
            for one in difflib.get_close_matches(
                name,
                [one.split("/")[2] for one in all_names if one.startswith(f"{package}/{kind}/")],
                n=1,
                cutoff=0.8,
            )
        ]
    if not same:
        return None
    # The same kind first, and what is nearest by its name: example_interfaces before others.
    best = min(same, key=lambda one: (one.split("/")[1] != kind, _unlike(package, one), one))
    owner, has_kind, has_name = best.split("/")
    missing = f"{package}.{kind}" if kind else package
    return (
        f"{missing} has no {name}, the {KIND_NAMES[has_kind]} {has_name} is in {owner}: write "
        f"from {owner}.{has_kind} import {has_name}."
    )


_OFTEN: Final = ("std_msgs", "geometry_msgs", "sensor_msgs", "std_srvs", "example_interfaces")


def _unlike(package: str, name: str) -> tuple[float, int]:
    owner = name.partition("/")[0]
    place = _OFTEN.index(owner) if owner in _OFTEN else len(_OFTEN)
    alike = difflib.SequenceMatcher(None, package, owner).ratio()
    return (0.0 if alike > 0.8 else 1.0, place)
