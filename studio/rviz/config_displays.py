"""Displays in `.rviz` files: an entry as settings of the studio, and settings back into it."""

from __future__ import annotations

from collections.abc import Mapping  # noqa: TC003 - msgspec reads it
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Final, Literal, TypeGuard

from studio.displays.catalogue import display_of_kind
from studio.displays.properties import Value
from studio.errors import DisplayError
from studio.ros.messages import shared_types
from studio.rviz.config_kinds import (
    JOINT_AXIS,
    JOINT_PARTS,
    JOINTS,
    LINK_PARTS,
    LISTS,
    OURS,
    PLUGINS,
    RVIZ1,
    UPDATE_TOPIC,
    UPDATES,
    class_of,
    is_ours,
    kind_of,
    missing_of,
    more_of,
    place_of,
    topic_key,
)
from studio.rviz.config_text import Tree, quoted, scalar_of, text_of
from studio.rviz.config_values import (
    VALUE,
    Entry,
    at,
    leaves,
    merged,
    name_in,
    number_of,
    path_of,
    put,
    read_value,
    scalar_at,
    switch_of,
    text_at,
    write_value,
)

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from studio.displays.display import Display
    from studio.displays.properties import Property
    from studio.rviz.config_values import Path

NAME_MAX: Final = 80
_TOPIC_MAX: Final = 300
_DEPTH_MAX: Final = 10_000
_POLICIES: Final = {
    "Durability Policy": ("Volatile", "Transient Local"),
    "History Policy": ("Keep Last",),
    "Reliability Policy": ("Reliable", "Best Effort"),
}
"""What of a topic's QoS is taken."""
_OF_TOPIC: Final = frozenset({(), (VALUE,), ("Depth",), *((one,) for one in _POLICIES)})
_SOURCE: Final = "Description Source"
_RVIZ_SOURCES: Final = ("Topic", "File")
_OUR_SOURCE: Final = (OURS, _SOURCE)
_TREE_LOOKS: Final = frozenset({
    ("Links", "Expand Joint Details"), ("Links", "Expand Link Details"), ("Links", "Expand Tree"),
    ("Links", "Link Tree Style"),
})  # fmt: skip
"""How RViz's own window lists links."""
_HEAD: Final = frozenset({("Class",), ("Name",), ("Enabled",), (VALUE,)})

LossReason = Literal[
    "no_display",
    "no_property",
    "no_value",
    "no_tool",
    "no_view",
    "no_panel",
    "no_option",
    "empty_group",
    "window",
]


@dataclass(frozen=True, slots=True)
class Loss:
    """Something of a file that is only kept.

    Attributes:
        reason: There is no such display, property, tool, view, panel or option here, or it does
            not take the value; a group is empty; `window` is what RViz notes of its own window.
        what: The class in the file, or the part of the file.
        names: The properties; none: the whole of it.
    """

    reason: LossReason
    what: str
    names: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class ConfigDisplay:
    """A display of a file.

    Attributes:
        kind: As `LaserScan`; one that there is not here has its whole class, with a slash in it.
        name: At most 80 letters of it.
        enabled: Whether it is switched on.
        group: Names of the groups around it, with slashes; empty: it is in none.
        topic: With its slash; empty: none.
        reliable: None: chosen to fit the publishers, as are the two below.
        latched: Whether durability is transient local.
        depth: Of the queue.
        values: Properties that differ from their defaults.
        entry: As it stands in the file; empty: it was in none.
    """

    kind: str
    name: str
    enabled: bool = True
    group: str = ""
    topic: str = ""
    reliable: bool | None = None
    latched: bool | None = None
    depth: int | None = None
    values: Mapping[str, Value] = field(default_factory=dict[str, Value])
    entry: Entry = field(default_factory=dict[str, Tree])


def read_display(entry: Entry) -> tuple[ConfigDisplay, list[Loss]]:
    """Return the display of an entry, and what of it is only kept."""
    class_name = text_at(entry, "Class")
    kind = kind_of(class_name)
    read = ConfigDisplay(kind, name_of(entry), is_enabled(entry), entry=entry)
    if kind.startswith(PLUGINS):
        return _with_topic(replace(read, values=_values_as_written(entry)), entry), []
    if "/" in kind:
        return read, [Loss("no_display", class_name)]
    display = display_of_kind(kind)(shared_types())
    values, refused, seen = _values_of(entry, kind, display)
    read = replace(read, values=values)
    if display.TOPICS or topic_key(kind) in entry:
        read = _with_topic(read, entry)
        refused.update(_refused_of_topic(entry, _topic_key_in(entry, kind)))
    left = _left_of(read, entry, seen)
    losses = [
        Loss("no_value", class_name, tuple(sorted(refused))) if refused else None,
        Loss("no_property", class_name, tuple(left)) if left else None,
    ]
    return read, [one for one in losses if one is not None]


def write_display(display: ConfigDisplay) -> Entry:
    """Return the entry of a display: what the file already says keeps its text."""
    kind = display.kind
    if "/" in kind:
        return _with_values_as_written(_with_head(display.entry, display), display)
    entry = display.entry or _fresh_entry(kind)
    entry = _with_head(entry, display)
    entry = _with_values(entry, display)
    made = display_of_kind(kind)(shared_types())
    return _with_listening(entry, display) if made.TOPICS or display.topic else entry


def name_of(entry: Entry) -> str:
    """Return the name of a display, on one line and not too long."""
    return name_in(entry, NAME_MAX) or text_at(entry, "Class").rpartition("/")[2][:NAME_MAX] or "?"


def is_enabled(entry: Entry) -> bool:
    """Return whether a display or group is on: Enabled counts before Value; without both, off."""
    for key in ("Enabled", VALUE):
        if (found := switch_of(text_at(entry, key))) is not None:
            return found
    return False


def _with_head(entry: Entry, display: ConfigDisplay) -> Entry:
    if name_of(entry) != display.name:
        entry = put(entry, ("Name",), scalar_of(display.name))
    return switched(entry, on=display.enabled)


def switched(entry: Entry, *, on: bool) -> Entry:
    """Return the entry of a display or group that is on or off."""
    if is_enabled(entry) == on:
        return entry
    for key in ("Enabled", VALUE):
        entry = put(entry, (key,), "true" if on else "false")
    return entry


def _values_as_written(entry: Entry) -> dict[str, Value]:
    """Return all that an entry says, of a kind whose properties are not known."""
    return {
        "/".join(path): _as_written(one)
        for path, one in leaves(entry)
        if path not in _HEAD and path[0] != "Topic" and isinstance(one, str)
    }


def _as_written(scalar: str) -> Value:
    if (on := _SWITCHES.get(scalar)) is not None:
        return on
    number = None if scalar.startswith('"') else number_of(scalar)
    return text_of(scalar) if number is None else number


_SWITCHES: Final = {"true": True, "false": False}


def _with_values_as_written(entry: Entry, display: ConfigDisplay) -> Entry:
    """Return the entry of a kind that is not known here; of an owner's own one with its values."""
    if not display.kind.startswith(PLUGINS):
        return entry
    if not display.entry:
        entry = {"Class": scalar_of(display.kind), **entry}
    for name, value in display.values.items():
        path = path_of(name)
        said = scalar_at(entry, path)
        if said is None or _as_written(said) != value:
            entry = put(entry, path, _scalar_of_value(value))
    return _with_listening(entry, display) if display.topic or "Topic" in entry else entry


def _scalar_of_value(value: Value) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int | float):
        return repr(value)
    return scalar_of(value) if value else quoted("")


def _values_of(
    entry: Entry, kind: str, display: Display
) -> tuple[dict[str, Value], set[str], set[Path]]:
    """Return the values that differ, the names of those that are refused, and the places read."""
    refused: set[str] = set()
    seen: set[Path] = set()
    for name, value in missing_of(entry, kind).items():
        display.set(name, value)
    for one, path in _places_of(entry, kind, display):
        found = at(entry, path)
        if found is None:
            continue
        seen |= {path, (*path, VALUE)}
        scalar = scalar_at(entry, path)
        value = None if scalar is None else read_value(one, scalar)
        if value is None and isinstance(found, dict) and scalar is None:
            continue  # only others are below it
        if value is None or not _took(display, one.name, value):
            refused.add(one.name)
    if ours := _our_source(entry, display):
        display.set(_SOURCE, ours)
    defaults = {one.name: one.default for one in display.PROPERTIES}
    differing = {
        name: value
        for name, value in display.values.items()
        if value != defaults.get(name, _default_of(display, name))
    }
    return differing, refused, seen


def _places_of(entry: Entry, kind: str, display: Display) -> Iterator[tuple[Property, Path]]:
    """Yield the properties that an entry may say, those of all before those of each."""
    for one in display.PROPERTIES:
        yield one, place_of(kind, one.name)
    for name in _listed(entry, kind):
        yield _property_of(display, name), place_of(kind, name)


def _listed(entry: Entry, kind: str) -> Iterator[str]:
    """Yield names of properties that come with messages, as namespaces."""
    group = LISTS.get(kind, "")
    found = entry.get(group)
    if not isinstance(found, dict):
        return
    for key, value in found.items():
        name = f"{group}/{text_of(key)}"
        if (group, key) in _TREE_LOOKS or key in ("All Enabled", "All Links Enabled"):
            continue
        if group == "Links" and _is_joint(value):
            yield from (f"{JOINTS}/{text_of(key)}/{part}" for part in JOINT_PARTS if part in value)
            continue
        yield name
        if group == "Links" and isinstance(value, dict):
            yield from (f"{name}/{part}" for part in LINK_PARTS if part in value)


def _is_joint(value: Tree | None) -> TypeGuard[Entry]:
    """Whether what is listed among the links is a joint."""
    return isinstance(value, dict) and JOINT_AXIS in value


def _property_of(display: Display, name: str) -> Property:
    return display.property_named(name)


def _default_of(display: Display, name: str) -> Value:
    return _property_of(display, name).default


def _took(display: Display, name: str, value: Value) -> bool:
    if display.values.get(name) == value:
        return True
    try:
        display.set(name, value)
    except DisplayError:
        return False
    return True


def _our_source(entry: Entry, display: Display) -> str:
    """Return where a description comes from that RViz cannot name."""
    if display.KIND != "RobotModel":
        return ""
    ours = text_at(entry, *_OUR_SOURCE)
    return ours if ours in ("Parameter", "Document") else ""


def _with_values(entry: Entry, display: ConfigDisplay) -> Entry:
    kind = display.kind
    made = display_of_kind(kind)(shared_types())
    values = dict(display.values)
    source = str(values.get(_SOURCE, "Topic"))
    if kind == "RobotModel":
        ours = source if source not in _RVIZ_SOURCES else ""
        if text_at(entry, *_OUR_SOURCE) != ours:
            entry = put(entry, _OUR_SOURCE, ours or quoted(""))
        if ours:
            values[_SOURCE] = "Topic"
    names = dict.fromkeys((*(one.name for one in made.PROPERTIES), *_listed(entry, kind), *values))
    every = values.get(LISTS[kind], True) if kind == "TF" else True
    told: list[tuple[Path, Property, Value]] = []
    rviz: Mapping[str, Value] = missing_of(display.entry, kind) if display.entry else {}
    missing: dict[str, Value] = {}
    for name in names:
        try:
            one = _property_of(made, name)
        except DisplayError:  # kept by another studio
            continue
        default = every if name.startswith("Frames/") else one.default
        missing[name] = rviz.get(name, default)
        told.append((place_of(kind, name), one, values.get(name, default)))
        if name in values and name.startswith(f"{JOINTS}/"):
            entry = _with_joint(entry, place_of(kind, name))
    return merged(entry, _without_silent(entry, told, display), missing)


def _with_joint(entry: Entry, place: Path) -> Entry:
    """Return an entry that lists a joint so that it is known as one."""
    joint = place[:-1]
    return entry if _is_joint(at(entry, joint)) else put(entry, (*joint, JOINT_AXIS), "false")


def _without_silent(
    entry: Entry, told: Iterable[tuple[Path, Property, Value]], display: ConfigDisplay
) -> Iterator[tuple[Path, Property, Value]]:
    """Leave out links that the file names without a value, and were not switched here."""
    for path, one, value in told:
        is_group = isinstance(at(entry, path), dict) and scalar_at(entry, path) is None
        if not is_group or one.name in display.values:
            yield path, one, value


def _fresh_entry(kind: str) -> Entry:
    """Return an entry with all that RViz2 writes, at its first values."""
    head: Entry = {"Class": class_of(kind), "Enabled": "true", "Name": kind, VALUE: "true"}
    entry = {**head, **more_of(kind)}
    for one in display_of_kind(kind).PROPERTIES:
        if not is_ours(kind, one.name):
            entry = put(entry, place_of(kind, one.name), write_value(one, one.default))
    return _sorted(entry)


def _sorted(entry: Entry) -> Entry:
    return {
        key: _sorted(value) if isinstance(value, dict) else value
        for key, value in sorted(entry.items())
    }


def _with_topic(display: ConfigDisplay, entry: Entry) -> ConfigDisplay:
    key = _topic_key_in(entry, display.kind)
    if key == "Robot Description" and key not in entry:
        return display
    latched = {"Transient Local": True}.get(text_at(entry, key, "Durability Policy"))
    reliable = {"Best Effort": False}.get(text_at(entry, key, "Reliability Policy"))
    if switch_of(text_at(entry, "Unreliable")):
        reliable = False
    topic, depth = _topic_of(entry, key), _depth_of(entry, key)
    return replace(display, topic=topic, reliable=reliable, latched=latched, depth=depth)


def _topic_key_in(entry: Entry, kind: str) -> str:
    """Return where an entry has its topic: RViz 1 has other places."""
    is_rviz1 = text_at(entry, "Class").startswith(f"{RVIZ1}/")
    return topic_key(kind, rviz1=is_rviz1 and topic_key(kind) not in entry)


def _topic_of(entry: Entry, key: str) -> str:
    topic = text_at(entry, key).strip()
    if len(topic) > _TOPIC_MAX or not topic.isprintable():
        return ""
    return f"/{topic}" if topic and topic[0] not in "/~" else topic


def _depth_of(entry: Entry, key: str) -> int | None:
    depth = number_of(text_at(entry, key, "Depth"))
    if depth is None or depth in (5, 0) or not 1 <= depth <= _DEPTH_MAX:
        return None
    return int(depth)


def _refused_of_topic(entry: Entry, key: str) -> Iterator[str]:
    """Yield what a topic says of itself and of its QoS that is not taken here."""
    if text_at(entry, key).strip() and not _topic_of(entry, key):
        yield key
    for policy, taken in _POLICIES.items():
        if text_at(entry, key, policy) not in ("", *taken):
            yield f"{key}/{policy}"
    depth = number_of(text_at(entry, key, "Depth") or "1")
    if depth is None or not 0 <= depth <= _DEPTH_MAX:
        yield f"{key}/Depth"


def _with_listening(entry: Entry, display: ConfigDisplay) -> Entry:
    said = _with_topic(display, entry)
    key = _topic_key_in(entry, display.kind)
    if said.topic != display.topic:
        entry = put(entry, (key,), scalar_of(display.topic) if display.topic else quoted(""))
        if display.kind == "Map" and "Update Topic" in entry:
            updates = f"{display.topic}{UPDATES}" if display.topic else ""
            entry = put(entry, UPDATE_TOPIC, scalar_of(updates) if updates else quoted(""))
    if said.reliable != display.reliable:
        policy = "Best Effort" if display.reliable is False else "Reliable"
        entry = put(entry, (key, "Reliability Policy"), policy)
    if said.latched != display.latched:
        policy = "Transient Local" if display.latched else "Volatile"
        entry = put(entry, (key, "Durability Policy"), policy)
    if said.depth != display.depth:
        entry = put(entry, (key, "Depth"), str(display.depth or 5))
    return entry


def _left_of(read: ConfigDisplay, entry: Entry, seen: set[Path]) -> list[str]:
    """Return the properties that have no counterpart here, nor concern RViz's own window."""
    kind = read.kind
    topics = (topic_key(kind), _topic_key_in(entry, kind))
    silent = {"Tree", OURS, *_silent_of(read, entry)}
    left: set[str] = set()
    for path, _ in leaves(entry):
        is_topic = path[0] in topics and path[1:] in _OF_TOPIC
        known = path in seen or path in _HEAD or path in _TREE_LOOKS or _is_joint_on(entry, path)
        if not (is_topic or known or path[0] in silent):
            left.add(_told(path))
    return sorted(left)


def _is_joint_on(entry: Entry, path: Path) -> bool:
    """Whether a path is that of a joint whose links are shown, as they are at first."""
    is_value = path[0] == "Links" and path[-1] == VALUE and _is_joint(at(entry, path[:-1]))
    return is_value and switch_of(text_at(entry, *path)) is True


def _told(path: Path) -> str:
    """Return a property that each link or frame may have, once for all."""
    return f"{path[0]}/{path[-1]}" if path[0] in LISTS.values() else "/".join(path)


def _silent_of(read: ConfigDisplay, entry: Entry) -> Iterator[str]:
    """Yield what says what the studio does anyway."""
    if text_at(entry, "Class").startswith(f"{RVIZ1}/"):
        yield "Unreliable"
    updates = text_at(entry, *UPDATE_TOPIC)
    if read.kind == "Map" and updates in ("", f"{read.topic}{UPDATES}"):
        yield UPDATE_TOPIC[0]
