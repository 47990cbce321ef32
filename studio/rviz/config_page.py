"""The studio's own part of a config file: panels, layouts and plots of a page, beside RViz's parts.

It stands below `Studio` in a file that is otherwise RViz's own, so that one file holds all and RViz
reads it, too. What a newer studio wrote there is kept.
"""

from __future__ import annotations

import json
import math
from typing import TYPE_CHECKING, Any, Final, cast

from studio.errors import RvizConfigError
from studio.rviz.config_kinds import RVIZ1
from studio.rviz.config_text import DEPTH_MAX, NODES_MAX, quoted, scalar_of, text_of
from studio.rviz.config_values import Entry, entries_at, entry_at, number_of, text_at

if TYPE_CHECKING:
    from collections.abc import Mapping

    from studio.rviz.config_text import Tree

PAGE: Final = "Studio"
"""Where it stands in a file."""
VERSION: Final = 1
OPEN: Final = "Open"
"""What a page is told of a file without such a part: ids of panels that it opens, as RViz does."""
RVIZ_PANELS: Final[Mapping[str, str]] = {
    "Displays": "displays",
    "Help": "",
    "Selection": "selection",
    "Time": "time",
    "Tool Properties": "tools",
    "Views": "views",
}
"""Panels of RViz, and the ids of those that show the same here; empty: RViz's own help."""
_OF_PANELS: Final = frozenset({"rviz_common", RVIZ1})
_VERSION: Final = "Version"
_WHOLE_BELOW: Final = 2**53
PAGE_TEXT_MAX: Final = 300_000
"""Letters of JSON."""


def page_entry(text: str, before: Entry) -> Entry:
    """Return the part for what a page tells as a JSON object; what it does not name stays.

    Raises:
        RvizConfigError: It is no such object.
    """
    try:
        told = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise RvizConfigError(f"what the page tells is no JSON: {error}") from error
    if not isinstance(told, dict):
        raise RvizConfigError("what the page tells is no JSON object")
    budget = [NODES_MAX]
    made = _tree_of(cast("dict[str, Any]", told), budget, 0)
    assert isinstance(made, dict)
    return {**before, **made, _VERSION: str(VERSION)}


def panel_of(entry: Entry) -> str | None:
    """Return which of RViz's panels an entry of a file is; None: one of a plug-in."""
    package, _, name = text_at(entry, "Class").partition("/")
    return name if package in _OF_PANELS and name in RVIZ_PANELS else None


def page_of(tree: Entry) -> str:
    """Return what a file says of a page as JSON: its part, else RViz's panels; empty: nothing."""
    if part := entry_at(tree, PAGE):
        return page_text(part)
    found = (RVIZ_PANELS[panel_of(one) or "Help"] for one in entries_at(tree, "Panels"))
    panels = list(dict.fromkeys(filter(None, found)))
    return json.dumps({OPEN: panels}) if panels else ""


def page_text(entry: Entry) -> str:
    """Return the part as JSON for a page; empty: there is none, or only a newer studio reads it."""
    version = number_of(text_at(entry, _VERSION))
    if not entry or version is None or version > VERSION:
        return ""
    text = json.dumps(_json_of(entry), allow_nan=False)
    return text if len(text) <= PAGE_TEXT_MAX else ""


def _tree_of(value: Any, budget: list[int], depth: int) -> Tree:  # noqa: ANN401 - JSON
    budget[0] -= 1
    if budget[0] < 0 or depth > DEPTH_MAX - 2:
        raise RvizConfigError("what the page tells is too much")
    if isinstance(value, dict):
        told = cast("dict[str, Any]", value)
        return {scalar_of(key): _tree_of(one, budget, depth + 1) for key, one in told.items()}
    if isinstance(value, list):
        return [_tree_of(one, budget, depth + 1) for one in cast("list[Any]", value)]
    return _scalar_of(value)


def _scalar_of(value: object) -> str:
    if value is None:
        return "~"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int | float):
        return json.dumps(value) if math.isfinite(value) else "~"
    return scalar_of(str(value)) if value else quoted("")


def _json_of(tree: Tree) -> Any:  # noqa: ANN401 - JSON
    if isinstance(tree, dict):
        return {text_of(key): _json_of(value) for key, value in tree.items()}
    if isinstance(tree, list):
        return [_json_of(one) for one in tree]
    return _value_of(tree)


_NAMED: Final[Mapping[str, bool | None]] = {"true": True, "false": False, "~": None}


def _value_of(scalar: str) -> bool | int | float | str | None:
    if scalar.startswith('"'):
        return text_of(scalar)
    if scalar in _NAMED:
        return _NAMED[scalar]
    try:
        number = float(scalar.replace("_", "x"))
    except ValueError:
        return scalar
    if not math.isfinite(number):
        return scalar
    return int(number) if number == int(number) and abs(number) < _WHOLE_BELOW else number
