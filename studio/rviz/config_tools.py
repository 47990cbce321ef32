"""Tools in `.rviz` files."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

from studio.errors import RvizConfigError
from studio.rviz.config_displays import NAME_MAX, Loss
from studio.rviz.config_kinds import RVIZ1
from studio.rviz.config_lists import entries_between
from studio.rviz.config_text import scalar_of
from studio.rviz.config_values import (
    Entry,
    kind_in,
    leaves,
    list_at,
    name_in,
    number_of,
    number_text,
    path_of,
    put,
    text_at,
    values_in,
    with_values,
    write_value,
)
from studio.rviz.tools import (
    ACTION,
    COVARIANCES,
    FRAME,
    SEND_AS,
    TOOL_KINDS,
    TOOLS_MAX,
    ToolKind,
    ToolSpec,
    default_tools,
)

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from studio.rviz.config_text import Tree

_HEAD: Final = frozenset({("Class",), ("Name",)})
DEVIATIONS: Final[Mapping[str, str]] = dict(
    zip(COVARIANCES, ("X std deviation", "Y std deviation", "Theta std deviation"), strict=True)
)
"""What RViz 1 has where RViz2 has covariances, which are their squares."""
_OURS: Final = frozenset({FRAME, SEND_AS, ACTION})
"""RViz2 has no such properties."""
_ALWAYS_HERE: Final = "Interact"
"""The studio adds one where a file has none."""


def read_tools(entries: Sequence[Entry]) -> tuple[tuple[ToolSpec, ...], list[Loss]]:
    """Return the tools of a file, without ids, and what of them is only kept.

    Raises:
        RvizConfigError: There are too many.
    """
    tools: list[ToolSpec] = []
    losses: list[Loss] = []
    for entry in entries:
        kind = kind_in(entry, TOOL_KINDS)
        if kind is None:
            losses.append(Loss("no_tool", text_at(entry, "Class")))
        else:
            tool, lost = _read(entry, kind)
            tools.append(tool)
            losses += lost
    if len(tools) >= TOOLS_MAX:  # one place is for Interact, which may be added
        raise RvizConfigError(f"it has more than {TOOLS_MAX - 1} tools")
    return tuple(tools), losses


def merge_tools(manager: Entry, tools: Sequence[ToolSpec], *, is_new: bool = False) -> Entry:
    """Return the manager's entry with these tools; unknown ones stay behind the same.

    A file without any stays so as long as the tools are RViz's first set, unless it `is_new`.
    """
    before = list_at(manager, "Tools")
    if not tools or (not before and not is_new and _are_first(tools)):
        return manager
    known = [one for one in tools if one.kind in TOOL_KINDS and not _is_added_here(one, before)]
    written = [(one.entry, _merged(one.entry, one)) for one in known]
    merged = entries_between(before, written, TOOL_KINDS)
    return {**manager, "Tools": merged} if merged or before else manager


def _are_first(tools: Sequence[ToolSpec]) -> bool:
    """Whether these are the tools of a document that has no list of its own."""
    return [(one.kind, one.name, dict(one.values)) for one in tools] == [
        (one.kind, one.name, {}) for one in default_tools()
    ]


def _is_added_here(tool: ToolSpec, before: Sequence[Tree]) -> bool:
    return len(before) > 0 and tool.kind == _ALWAYS_HERE and not (tool.values or tool.entry)


def _name_of(entry: Entry, kind: ToolKind) -> str:
    return name_in(entry, NAME_MAX) or kind.name


def _read(entry: Entry, kind: ToolKind) -> tuple[ToolSpec, list[Loss]]:
    values, refused = values_in(entry, kind.properties)
    if _is_of_rviz1(entry):
        values |= _covariances_of(entry, kind)
    known = {path_of(one.name) for one in kind.properties} | _HEAD
    known |= {(DEVIATIONS[one.name],) for one in kind.properties if one.name in DEVIATIONS}
    known |= {(*path, "Value") for path in known}
    left = ["/".join(path) for path, _ in leaves(entry) if path not in known]
    class_name = text_at(entry, "Class")
    losses = [Loss("no_value", class_name, refused)] if refused else []
    losses += [Loss("no_property", class_name, tuple(left))] if left else []
    return ToolSpec("", kind.kind, _name_of(entry, kind), values, entry), losses


def _merged(entry: Entry, tool: ToolSpec) -> Entry:
    kind = TOOL_KINDS[tool.kind]
    entry = entry or _fresh(kind)
    if _name_of(entry, kind) != tool.name:
        entry = put(entry, ("Name",), scalar_of(tool.name))
    if not _is_of_rviz1(entry):
        return with_values(entry, kind.properties, tool.values)
    others = [one for one in kind.properties if one.name not in DEVIATIONS]
    return _with_deviations(with_values(entry, others, tool.values), tool)


def _is_of_rviz1(entry: Entry) -> bool:
    return text_at(entry, "Class").startswith(f"{RVIZ1}/")


def _covariances_of(entry: Entry, kind: ToolKind) -> dict[str, float]:
    """Return what RViz 1 tells as standard deviations, where it is not RViz's first."""
    values: dict[str, float] = {}
    for one in kind.properties:
        deviation = number_of(text_at(entry, DEVIATIONS.get(one.name, "")))
        if deviation is None:
            continue
        covariance = float(one.checked(deviation * deviation))
        if not math.isclose(covariance, float(one.default), rel_tol=1e-6):
            values[one.name] = covariance
    return values


def _with_deviations(entry: Entry, tool: ToolSpec) -> Entry:
    kind = TOOL_KINDS[tool.kind]
    said = _covariances_of(entry, kind)
    for one in kind.properties:
        value = tool.value(one.name)
        if one.name in DEVIATIONS and said.get(one.name, one.default) != value:
            entry = put(entry, (DEVIATIONS[one.name],), number_text(math.sqrt(float(value))))
    return entry


def _fresh(kind: ToolKind) -> Entry:
    """Return an entry with all that RViz2 writes of a tool, at its first values."""
    entry: Entry = {"Class": f"rviz_default_plugins/{kind.kind}"}
    for one in kind.properties:
        if one.name not in _OURS:
            entry = put(entry, path_of(one.name), write_value(one, one.default))
    return entry
