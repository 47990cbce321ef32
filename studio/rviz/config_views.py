"""Views in `.rviz` files: the one in use and those that were saved."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from studio.errors import RvizConfigError
from studio.rviz.config_displays import Loss
from studio.rviz.config_lists import entries_between
from studio.rviz.config_text import scalar_of
from studio.rviz.config_values import (
    Entry,
    entry_at,
    kind_in,
    leaves,
    list_at,
    name_in,
    path_of,
    put,
    text_at,
    values_in,
    with_values,
    write_value,
)
from studio.rviz.views import (
    NAME_MAX,
    ORTHOGRAPHIC,
    VIEW_KINDS,
    VIEWS_MAX,
    ViewKind,
    ViewSpec,
)

if TYPE_CHECKING:
    from collections.abc import Sequence

_CURRENT: Final = "Current View"
_HEAD: Final = frozenset({("Class",), ("Name",), ("Value",)})
_HIDDEN: Final = "Invert Z Axis"
"""RViz2 writes it of all kinds; of those that lack it here it hides it and does not heed it."""
_STEREO: Final[Entry] = {
    "Stereo Eye Separation": "0.05999999865889549",
    "Stereo Focal Distance": "1",
    "Swap Stereo Eyes": "false",
    "Value": "false",
}


def read_current(entry: Entry) -> tuple[ViewSpec | None, list[Loss]]:
    """Return the view in use, and what of it is only kept; None: there is no such view here."""
    kind = kind_in(entry, VIEW_KINDS)
    if kind is not None:
        return _read(entry, kind)
    class_name = text_at(entry, "Class")
    return None, [Loss("no_view", class_name)] if class_name else []


def read_views(entries: Sequence[Entry]) -> tuple[tuple[ViewSpec, ...], list[Loss]]:
    """Return the views that were saved, and what of them is only kept.

    Raises:
        RvizConfigError: There are too many.
    """
    views: list[ViewSpec] = []
    losses: list[Loss] = []
    for entry in entries:
        view, lost = read_current(entry)
        losses += lost
        if view is not None:
            views.append(view)
    if len(views) > VIEWS_MAX:
        raise RvizConfigError(f"it has more than {VIEWS_MAX} saved views")
    return tuple(views), losses


def merge_view(manager: Entry, view: ViewSpec) -> Entry:
    """Return the manager's entry with this view in use."""
    entry = _merged(entry_at(manager, "Views", "Current"), view, _CURRENT)
    return {**manager, "Views": {**entry_at(manager, "Views"), "Current": entry}}


def merge_views(manager: Entry, views: Sequence[ViewSpec]) -> Entry:
    """Return the manager's entry with these saved views; unknown ones stay behind the same."""
    before = list_at(manager, "Views", "Saved")
    if not before and not views:
        return manager
    written = [(one.entry, _merged(one.entry, one, one.name)) for one in views]
    saved = entries_between(before, written, VIEW_KINDS)
    return {**manager, "Views": {**entry_at(manager, "Views"), "Saved": saved}}


def _read(entry: Entry, kind: ViewKind) -> tuple[ViewSpec, list[Loss]]:
    values, refused = values_in(entry, kind.properties)
    known = {path_of(one.name) for one in kind.properties} | _HEAD | {(_HIDDEN,)}
    left = [path for path, _ in leaves(entry) if path not in known]
    names = dict.fromkeys(path[0] for path in left)
    class_name = text_at(entry, "Class")
    losses = [Loss("no_value", class_name, refused)] if refused else []
    losses += [Loss("no_property", class_name, tuple(names))] if names else []
    return ViewSpec(kind.kind, name_in(entry, NAME_MAX), values, entry), losses


def _merged(entry: Entry, view: ViewSpec, name: str) -> Entry:
    kind = VIEW_KINDS[view.kind]
    if (found := kind_in(entry, VIEW_KINDS)) is None or found.kind != view.kind:
        entry = _fresh(kind)
    if name_in(entry, NAME_MAX) != name:
        entry = put(entry, ("Name",), scalar_of(name))
    return with_values(entry, kind.properties, view.values)


def _fresh(kind: ViewKind) -> Entry:
    """Return an entry with all that RViz2 writes of a view, at its first values."""
    entry: Entry = {
        "Class": f"rviz_default_plugins/{kind.kind}",
        "Enable Stereo Rendering": _STEREO,
        _HIDDEN: "false",
        "Name": _CURRENT,
        "Value": f"{kind.kind} (rviz_default_plugins)",
    }
    for one in kind.properties:
        if not _is_ours(kind, one.name):
            entry = put(entry, path_of(one.name), write_value(one, one.default))
    return dict(sorted(entry.items()))


def _is_ours(kind: ViewKind, name: str) -> bool:
    """Whether RViz2 has no such property; RViz 1 has the field of view."""
    return name in (ORTHOGRAPHIC, "Field of View") or (
        name == "Scale" and kind.kind != "TopDownOrtho"
    )
