"""`.rviz` files: displays, groups, options, tools and views as values, and back into the same tree.

What has no counterpart in the studio stays in the tree, which a document keeps beside its own
values: saving changes only what these say otherwise.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Final

from studio.errors import RvizConfigError
from studio.rviz.config_displays import (
    ConfigDisplay,
    Loss,
    is_enabled,
    read_display,
    switched,
    write_display,
)
from studio.rviz.config_groups import group_name, name_in_path
from studio.rviz.config_kinds import GROUPS, OURS, RVIZ1, class_in_rviz2
from studio.rviz.config_page import PAGE, panel_of
from studio.rviz.config_text import is_null, read_tree, scalar_of, text_of, write_tree
from studio.rviz.config_tools import DEVIATIONS, merge_tools, read_tools
from studio.rviz.config_values import (
    Entry,
    at,
    colour_of,
    colour_text,
    entries_at,
    entry_at,
    number_of,
    put,
    text_at,
)
from studio.rviz.config_views import merge_view, merge_views, read_current, read_views

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from studio.rviz.config_text import Tree
    from studio.rviz.tools import ToolSpec
    from studio.rviz.views import ViewSpec

DISPLAYS_MAX: Final = 200
"""As many as a document can have."""
FRAME_RATE_MAX: Final = 240
GROUP_DEPTH_MAX: Final = 8
"""So many groups stand in each other in a document."""
_RVIZ_FRAME_RATE: Final = 30
_RVIZ_BACKGROUND: Final = "#303030"
_MANAGER: Final = "Visualization Manager"
_DISPLAYS: Final = "Displays"
_OPTIONS: Final = "Global Options"
_FIXED: Final = (_OPTIONS, "Fixed Frame")
_BACKGROUND: Final = (_OPTIONS, "Background Color")
_OUR_BACKGROUND: Final = (_OPTIONS, OURS, "Background Color")
_FRAME_RATE: Final = (_OPTIONS, "Frame Rate")
_OUR_FRAME_RATE: Final = (_OPTIONS, OURS, "Frame Rate")
_FRAME_MAX: Final = 300
_PANEL_LOOKS: Final = frozenset({
    "Class", "Expanded", "Help Height", "Name", "Property Tree Widget", "Splitter Ratio",
    "Tree Height",
})  # fmt: skip
"""How RViz's own window shows a panel."""
_PANEL_FIRST: Final[Mapping[str, str]] = {
    "Experimental": "false", "SyncMode": "0", "SyncSource": "",
}  # fmt: skip
"""Settings of panels that have no counterpart here, as they are in RViz at first."""
_TOLD_OTHERWISE: Final = frozenset(DEVIATIONS.values())
_READ: Final = frozenset({
    "Class", _DISPLAYS, "Enabled", _OPTIONS, "Name", "Tools", "Transformation", "Value", "Views",
})  # fmt: skip


@dataclass(frozen=True, slots=True)
class RvizConfig:
    """A file as values.

    Attributes:
        displays: In their order, with those that the studio cannot show.
        groups: Entries of the groups by their paths, without what is in them.
        groups_off: Paths of those that are switched off.
        groups_empty: Paths of those in which nothing was, and how many stood before each in the
            group around it.
        fixed_frame: Empty: that of the robot's root link.
        background: As `#rrggbb`; empty: that of the theme.
        frame_rate: Pictures per second at most; 0: as many as there can be.
        tools: In their order; without ids.
        views: Those that were saved.
        view: The one that was in use; None: none that there is here.
        root: The robot's root link, which stands for an empty fixed frame.
        rest: The tree without its displays; empty: there was no file.
    """

    displays: tuple[ConfigDisplay, ...] = ()
    groups: Mapping[str, Entry] = field(default_factory=dict[str, Entry])
    groups_off: tuple[str, ...] = ()
    groups_empty: Mapping[str, int] = field(default_factory=dict[str, int])
    fixed_frame: str = ""
    background: str = ""
    frame_rate: int = 0
    tools: tuple[ToolSpec, ...] = ()
    views: tuple[ViewSpec, ...] = ()
    view: ViewSpec | None = None
    root: str = ""
    rest: Entry = field(default_factory=dict[str, "Tree"])


def read_config(text: str) -> tuple[RvizConfig, tuple[Loss, ...]]:
    """Return a file as values, and what of it is only kept.

    Raises:
        RvizConfigError: It is no `.rviz` file, or larger than any.
    """
    tree = read_tree(text)
    manager = at(tree, (_MANAGER,))
    if not isinstance(tree, dict) or not isinstance(manager, dict):
        raise RvizConfigError('it has no "Visualization Manager", as .rviz files have')
    reader = _DisplayReader(manager)
    tools, tool_losses = read_tools(entries_at(manager, "Tools"))
    views, view_losses = read_views(entries_at(manager, "Views", "Saved"))
    current, current_losses = read_current(entry_at(manager, "Views", "Current"))
    config = RvizConfig(
        displays=tuple(reader.displays),
        groups=reader.groups,
        groups_off=tuple(reader.groups_off),
        groups_empty=reader.groups_empty,
        fixed_frame=text_at(manager, *_FIXED)[:_FRAME_MAX].removeprefix("/"),
        background=_background_of(manager),
        frame_rate=_frame_rate_of(manager),
        tools=tools,
        views=views,
        view=current,
        rest={**tree, _MANAGER: _changed(manager, _DISPLAYS, []) if reader.found else manager},
    )
    others = (*tool_losses, *view_losses, *current_losses, *_other_losses(tree, manager))
    return config, _united((*reader.losses, *others))


def current_view(tree: Entry) -> ViewSpec | None:
    """Return the view of a file that was in use; None: none that there is here."""
    return read_current(entry_at(tree, _MANAGER, "Views", "Current"))[0]


def is_of_rviz1(config: RvizConfig) -> bool:
    """Whether a file names classes as RViz 1 does, which RViz2 does not know."""
    entries = [*config.groups.values(), *(one.entry for one in config.displays)]
    return any(text_at(one, "Class").startswith(f"{RVIZ1}/") for one in entries)


def for_rviz2(config: RvizConfig) -> RvizConfig:
    """Return a config whose file RViz2 opens: displays of RViz 1 are written anew.

    What of them has no counterpart here is not in it: RViz2 has other names for that.
    """
    return replace(
        config,
        displays=tuple(map(_display_for_rviz2, config.displays)),
        groups={path: _renamed(entry) for path, entry in config.groups.items()},
        tools=tuple(replace(one, entry=_renamed(one.entry)) for one in config.tools),
        views=tuple(replace(one, entry=_renamed(one.entry)) for one in config.views),
        rest=_renamed(config.rest),
    )


def _display_for_rviz2(display: ConfigDisplay) -> ConfigDisplay:
    if not text_at(display.entry, "Class").startswith(f"{RVIZ1}/"):
        return display
    is_known = "/" not in display.kind
    return replace(display, entry={} if is_known else _renamed(display.entry))


def _renamed(entry: Entry) -> Entry:
    """Return an entry in which all classes have RViz2's names, without what that has otherwise."""
    left = {key: value for key, value in entry.items() if key not in _TOLD_OTHERWISE}
    return {key: _renamed_value(key, value) for key, value in left.items()}


def _renamed_value(key: str, value: Tree) -> Tree:
    if isinstance(value, dict):
        return _renamed(value)
    if isinstance(value, list):
        return [_renamed(one) if isinstance(one, dict) else one for one in value]
    return scalar_of(class_in_rviz2(text_of(value))) if key == "Class" and text_of(value) else value


def write_config(config: RvizConfig) -> str:
    """Return the text of a file: what it said already stays as it was."""
    return write_tree(tree_of(config))


def tree_of(config: RvizConfig) -> Entry:
    """Return the tree of a file."""
    rest = config.rest or _FRESH
    manager = _with_options(entry_at(rest, _MANAGER), config)
    displays = _written(config, "")
    if displays:
        manager = _changed(manager, _DISPLAYS, displays)
    manager = merge_tools(manager, config.tools, is_new=not config.rest)
    manager = merge_views(manager, config.views)
    if config.view is not None:
        manager = merge_view(manager, config.view)
    return {**rest, _MANAGER: manager}


def _changed(entry: Entry, key: str, value: Tree) -> Entry:
    return {**entry, key: value}


class _DisplayReader:
    """Goes through the displays of a file, the groups among them."""

    def __init__(self, manager: Entry) -> None:
        self.displays: list[ConfigDisplay] = []
        self.groups: dict[str, Entry] = {}
        self.groups_off: list[str] = []
        self.groups_empty: dict[str, int] = {}
        self.losses: list[Loss] = []
        self._read(manager, "")

    @property
    def found(self) -> int:
        """How many displays there are, and groups in which none is."""
        return len(self.displays) + len(self.groups_empty)

    def _read(self, entry: Entry, group: str) -> None:
        for before, one in enumerate(_members(entry)):
            if text_at(one, "Class") in GROUPS:
                self._read_group(one, group, before)
            else:
                display, losses = read_display(one)
                self.displays.append(replace(display, group=group))
                self.losses += losses
            if self.found > DISPLAYS_MAX:
                raise RvizConfigError(f"it has more than {DISPLAYS_MAX} displays")

    def _read_group(self, entry: Entry, above: str, before: int) -> None:
        wanted = group_name(text_at(entry, "Name"))
        path = f"{above}/{wanted}" if above else wanted
        if path.count("/") >= GROUP_DEPTH_MAX:
            raise RvizConfigError(f"its groups are nested deeper than {GROUP_DEPTH_MAX}")
        count = 2
        while path in self.groups:
            path = f"{above}/{wanted} {count}" if above else f"{wanted} {count}"
            count += 1
        displays = len(self.displays)
        self.groups[path] = {**entry, _DISPLAYS: []} if _members(entry) else entry
        self._read(entry, path)
        if len(self.displays) == displays:
            self.groups_empty[path] = before
            self.losses.append(Loss("empty_group", text_at(entry, "Class"), (path,)))
        elif not is_enabled(entry):
            self.groups_off.append(path)


def _members(entry: Entry) -> list[Entry]:
    found = entry.get(_DISPLAYS, "~")
    if is_null(found):
        return []
    if not isinstance(found, list):
        raise RvizConfigError('its "Displays" are no list')
    members = [one for one in found if isinstance(one, dict)]
    if len(members) != len(found):
        raise RvizConfigError('one of its "Displays" has no properties')
    return members


def _written(config: RvizConfig, group: str) -> list[Tree]:
    """Return the displays of a group, with the groups in it where their first display is."""
    written: list[Tree] = []
    begun: set[str] = set()
    inside = f"{group}/" if group else ""
    for display in config.displays:
        if display.group == group:
            written.append(write_display(display))
        elif display.group.startswith(inside):
            step = display.group.removeprefix(inside).partition("/")[0]
            if step not in begun:
                begun.add(step)
                written.append(_written_group(config, f"{inside}{step}"))
    for path, before in _empty_in(config, inside).items():
        if path.removeprefix(inside) not in begun:
            written.insert(before, _written_empty(config, path))
    return written


def _empty_in(config: RvizConfig, inside: str) -> dict[str, int]:
    """Return the empty groups that stand in a group, in their order."""
    found = {
        path: before
        for path, before in config.groups_empty.items()
        if path.startswith(inside) and "/" not in path.removeprefix(inside)
    }
    return dict(sorted(found.items(), key=lambda one: one[1]))


def _written_empty(config: RvizConfig, path: str) -> Entry:
    """Return a group in which no display is; others may be that are as empty."""
    entry = config.groups[path]
    written = _written(config, path)
    return {**entry, _DISPLAYS: written} if written else entry


def _written_group(config: RvizConfig, path: str) -> Entry:
    name = name_in_path(path)
    fresh: Entry = {
        "Class": "rviz_common/Group",
        _DISPLAYS: [],
        "Enabled": "true",
        "Name": scalar_of(name),
        "Value": "true",
    }
    entry = switched(config.groups.get(path, fresh), on=path not in config.groups_off)
    return {**entry, _DISPLAYS: _written(config, path)}


def _background_of(manager: Entry) -> str:
    if text_at(manager, *_OUR_BACKGROUND) == "theme":
        return ""
    return colour_of(text_at(manager, *_BACKGROUND)) or ""


def _frame_rate_of(manager: Entry) -> int:
    for path in (_OUR_FRAME_RATE, _FRAME_RATE):
        rate = number_of(text_at(manager, *path))
        if rate is not None and 0 <= rate <= FRAME_RATE_MAX:
            return round(rate)
    return 0


def _with_options(manager: Entry, config: RvizConfig) -> Entry:
    if text_at(manager, *_FIXED)[:_FRAME_MAX].removeprefix("/") != config.fixed_frame:
        manager = put(manager, _FIXED, scalar_of(config.fixed_frame or config.root or "map"))
    if _background_of(manager) != config.background:
        ours = "theme" if not config.background else '""'
        if config.background or text_at(manager, *_OUR_BACKGROUND) or at(manager, _BACKGROUND):
            manager = put(manager, _OUR_BACKGROUND, ours)
        if config.background:
            manager = put(manager, _BACKGROUND, colour_text(config.background))
    if _frame_rate_of(manager) != config.frame_rate:
        if config.frame_rate:
            manager = put(manager, _FRAME_RATE, str(config.frame_rate))
        if not config.frame_rate or text_at(manager, *_OUR_FRAME_RATE):
            manager = put(manager, _OUR_FRAME_RATE, str(config.frame_rate))
    return manager


def _other_losses(tree: Entry, manager: Entry) -> Iterator[Loss]:
    """Yield what of the rest of a file has no counterpart here."""
    for panel in entries_at(tree, "Panels"):
        yield from _panel_losses(panel)
    options = entry_at(manager, _OPTIONS)
    taken = {_FIXED[1], _BACKGROUND[1], _FRAME_RATE[1], OURS}
    if left := [text_of(key) for key in options if key not in taken]:
        yield Loss("no_option", _OPTIONS, tuple(left))
    if left := [text_of(key) for key in manager if key not in _READ]:
        yield Loss("no_option", _MANAGER, tuple(left))
    transformer = text_at(manager, "Transformation", "Current", "Class")
    if transformer not in ("", "rviz_default_plugins/TF"):
        yield Loss("no_option", "Transformation", (transformer,))
    for key in tree:
        if key == "Window Geometry":
            yield Loss("window", key)
        elif key not in ("Panels", _MANAGER, PAGE):
            yield Loss("no_option", text_of(key), tuple(map(text_of, entry_at(tree, key))))


def _panel_losses(panel: Entry) -> Iterator[Loss]:
    class_name = text_at(panel, "Class")
    if panel_of(panel) is None:
        yield Loss("no_panel", class_name)
        return
    said = {text_of(key): text_at(panel, text_of(key)) for key in panel}
    settings = {key: one for key, one in said.items() if key not in _PANEL_LOOKS}
    left = [key for key, one in settings.items() if _PANEL_FIRST.get(key) != one]
    if left:
        yield Loss("no_property", class_name, tuple(left))


def _united(losses: Sequence[Loss]) -> tuple[Loss, ...]:
    """Return the losses, those of one reason and class as one."""
    names: dict[tuple[str, str], dict[str, None]] = {}
    first: dict[tuple[str, str], Loss] = {}
    for one in losses:
        key = (one.reason, one.what)
        first.setdefault(key, one)
        names.setdefault(key, {}).update(dict.fromkeys(one.names))
    return tuple(replace(one, names=tuple(names[key])) for key, one in first.items())


def _panel(name: str, **more: Tree) -> Entry:
    return {"Class": f"rviz_common/{name}", "Name": name, **more}


_FRESH: Final[Entry] = {
    "Panels": [
        _panel("Displays"), _panel("Selection"), _panel("Tool Properties"), _panel("Views"),
        _panel("Time"),
    ],
    _MANAGER: {
        "Class": '""',
        _DISPLAYS: [],
        "Enabled": "true",
        _OPTIONS: {
            _BACKGROUND[1]: colour_text(_RVIZ_BACKGROUND),
            _FIXED[1]: "map",
            _FRAME_RATE[1]: str(_RVIZ_FRAME_RATE),
        },
        "Name": "root",
        "Tools": [],
        "Transformation": {"Current": {"Class": "rviz_default_plugins/TF"}},
        "Value": "true",
        "Views": {
            "Current": {
                "Class": "rviz_default_plugins/Orbit",
                "Name": "Current View",
                "Value": "Orbit (rviz)",
            },
            "Saved": "~",
        },
    },
    "Window Geometry": {
        "Displays": {"collapsed": "false"},
        "Height": "846",
        "Hide Left Dock": "false",
        "Hide Right Dock": "false",
        "Selection": {"collapsed": "false"},
        "Time": {"collapsed": "false"},
        "Tool Properties": {"collapsed": "false"},
        "Views": {"collapsed": "false"},
        "Width": "1200",
        "X": "70",
        "Y": "60",
    },
}  # fmt: skip
"""What RViz2 writes beside what is set."""
