"""Properties in trees of `.rviz` files: where each stands, what its text means, how to write it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final, TypeVar

import numpy as np

from studio.errors import DisplayPropertyError
from studio.rviz.config_text import Tree, quoted, scalar_of, text_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from studio.displays.properties import Property, Value

Entry = dict[str, Tree]
Path = tuple[str, ...]
"""Names from the outside to the inside."""

VALUE: Final = "Value"
"""Where a property that has others below it keeps its own value."""
_PACKAGES: Final = frozenset({"rviz", "rviz_default_plugins"})
"""Of the tools and views of RViz 1 and RViz2."""
_ON: Final = frozenset({"true", "1", "yes", "on"})
_OFF: Final = frozenset({"false", "0", "no", "off"})
_FLOAT32_MAX: Final = 3e38
_WHOLE_BELOW: Final = 1e15

Kind = TypeVar("Kind")


def at(tree: Tree | None, path: Path) -> Tree | None:
    """Return what stands at a path; None: nothing."""
    for name in path:
        if not isinstance(tree, dict):
            return None
        tree = tree.get(key_in(tree, name))
    return tree


def key_in(entry: Entry, name: str) -> str:
    """Return the key of a name, quoted as it stands in the entry; a new one as it is needed."""
    if name in entry:
        return name
    written = quoted(name)
    return written if written in entry else scalar_of(name)


def scalar_at(tree: Tree | None, path: Path) -> str | None:
    """Return the scalar of the property at a path, which may have others below it."""
    found = at(tree, path)
    if isinstance(found, dict):
        found = found.get(VALUE)
    return found if isinstance(found, str) else None


def text_at(tree: Tree | None, *path: str) -> str:
    """Return the text of the property at a path; empty: none."""
    return text_of(scalar_at(tree, path) or "")


def kind_in(entry: Entry, kinds: Mapping[str, Kind]) -> Kind | None:
    """Return which of these kinds of tools or views the class of an entry is; None: none of RViz's.

    Args:
        entry: As it was read.
        kinds: By RViz's class without its package.
    """
    package, _, name = text_at(entry, "Class").partition("/")
    return kinds.get(name) if package in _PACKAGES else None


def name_in(entry: Entry, letters_max: int) -> str:
    """Return the name of an entry, on one line and not too long; empty: it has none."""
    return one_line(text_at(entry, "Name"))[:letters_max]


def one_line(text: str) -> str:
    """Return a text with a space for each letter that is not printed, and none around it."""
    return "".join(one if one.isprintable() else " " for one in text).strip()


def entry_at(tree: Tree | None, *path: str) -> Entry:
    """Return the properties below a path; empty: none."""
    found = at(tree, path)
    return found if isinstance(found, dict) else {}


def list_at(tree: Tree | None, *path: str) -> list[Tree]:
    """Return the list at a path; empty: none."""
    found = at(tree, path)
    return found if isinstance(found, list) else []


def entries_at(tree: Tree | None, *path: str) -> list[Entry]:
    """Return the entries of a list at a path."""
    return [one for one in list_at(tree, *path) if isinstance(one, dict)]


def put(entry: Entry, path: Path, scalar: str) -> Entry:
    """Return an entry with this scalar at a path; keys that were sorted stay so, as in RViz."""
    name, *rest = path
    key = key_in(entry, name)
    below = entry.get(key)
    if not rest:
        if isinstance(below, dict) and below:
            return _with(entry, key, _with(below, VALUE, scalar))
        return _with(entry, key, scalar)
    if not isinstance(below, dict):
        below = _below(below)
    return _with(entry, key, put(below, tuple(rest), scalar))


def _below(alone: Tree | None) -> Entry:
    """Return a scalar that gets others below it."""
    return {VALUE: alone} if isinstance(alone, str) and text_of(alone) else {}


def _with(entry: Entry, key: str, value: Tree) -> Entry:
    if key in entry:
        return {**entry, key: value}
    keys = list(entry)
    changed: Entry = {**entry, key: value}
    return dict(sorted(changed.items())) if keys == sorted(keys) else changed


def leaves(entry: Entry, above: Path = ()) -> Iterator[tuple[Path, Tree]]:
    """Yield all scalars and lists of an entry by their paths, of names without quotes."""
    for key, value in entry.items():
        path = (*above, text_of(key))
        if isinstance(value, dict):
            yield from leaves(value, path)
        else:
            yield path, value


def path_of(name: str) -> Path:
    """Return where the property of a name stands in its entry."""
    return tuple(name.split("/"))


def read_value(one: Property, scalar: str) -> Value | None:
    """Return the value that a scalar gives a property; None: it is none that it takes."""
    try:
        value = one.checked(_meaning(one, text_of(scalar)))
    except (DisplayPropertyError, ValueError, OverflowError):
        return None
    is_first = one.kind == "number" and number_text(float(value)) == write_value(one, one.default)
    return one.default if is_first else value


def values_in(
    entry: Entry, properties: Iterable[Property]
) -> tuple[dict[str, Value], tuple[str, ...]]:
    """Return the values that differ from their defaults, and the names of those refused."""
    values: dict[str, Value] = {}
    refused: list[str] = []
    for one in properties:
        scalar = scalar_at(entry, path_of(one.name))
        if scalar is None:
            continue
        value = read_value(one, scalar)
        if value is None:
            refused.append(one.name)
        elif value != one.default:
            values[one.name] = value
    return values, tuple(refused)


def write_value(one: Property, value: Value) -> str:
    """Return the scalar of a value as RViz2 writes it."""
    if one.kind == "switch":
        return "true" if value else "false"
    if one.kind == "whole":
        return str(int(value))
    if one.kind == "number":
        return number_text(float(value))
    if one.kind == "colour":
        return colour_text(str(value))
    text = _RVIZ_WORDS.get((one.name, str(value)), str(value))
    return scalar_of(text) if text else quoted("")


def same(one: Property, scalar: str | None, value: Value, missing: Value) -> bool:
    """Whether a scalar already says a value.

    Args:
        one: The property.
        scalar: As it stands in the file; None: nothing does.
        value: Of the studio now.
        missing: What the property is while the file says nothing that it takes.
    """
    said = None if scalar is None else read_value(one, scalar)
    return (missing if said is None else said) == value


def merged(
    entry: Entry, values: Iterable[tuple[Path, Property, Value]], missing: Mapping[str, Value]
) -> Entry:
    """Return an entry that says these values; what already does keeps its text.

    Args:
        entry: As it was read.
        values: Where each property stands, and its value now.
        missing: Values that properties have in RViz while the file says nothing; others have
            their defaults.
    """
    for path, one, value in values:
        if not same(one, scalar_at(entry, path), value, missing.get(one.name, one.default)):
            entry = put(entry, path, write_value(one, value))
    return entry


def with_values(entry: Entry, properties: Iterable[Property], values: Mapping[str, Value]) -> Entry:
    """Return an entry that says these values of properties, which stand under their names."""
    told = ((path_of(one.name), one, values.get(one.name, one.default)) for one in properties)
    return merged(entry, told, {})


def number_text(number: float) -> str:
    """Return a number as RViz2 writes it: of 32 bits, with all digits of 64."""
    single = float(np.float32(number)) if abs(number) < _FLOAT32_MAX else number
    return (
        str(int(single)) if single == int(single) and abs(single) < _WHOLE_BELOW else repr(single)
    )


def colour_text(colour: str) -> str:
    """Return a colour `#rrggbb` as RViz writes it, `25; 255; 0`."""
    return "; ".join(str(int(colour[at : at + 2], 16)) for at in (1, 3, 5))


def colour_of(text: str) -> str | None:
    """Return a colour of RViz as `#rrggbb`; None: it is none."""
    parts = text.split(";")
    try:
        rgb = [int(part) for part in parts if len(part) < 8]
    except ValueError:
        return None
    if len(parts) != 3 or len(rgb) != 3 or not all(0 <= part <= 255 for part in rgb):
        return None
    return "#" + "".join(f"{part:02x}" for part in rgb)


def switch_of(text: str) -> bool | None:
    """Return whether a text means on; None: it means neither."""
    word = text.strip().lower()
    return True if word in _ON else False if word in _OFF else None


def number_of(text: str) -> float | None:
    """Return the number that a text says, as short as its 32 bits can be told; None: it is none.

    RViz writes 0.03 as 0.029999999329447746.
    """
    if "_" in text:
        return None
    try:
        number = float(text)
    except ValueError:
        return None
    if not math.isfinite(number):
        return None
    if abs(number) < _FLOAT32_MAX and float(np.float32(number)) == number:
        return float(str(np.float32(number)))
    return number


def _meaning(one: Property, text: str) -> Value | None:
    if one.kind == "switch":
        return switch_of(text)
    if one.kind in ("whole", "number"):
        return number_of(text)
    if one.kind == "colour":
        return colour_of(text) or text
    return _OUR_WORDS.get((one.name, text), text)


_RVIZ_WORDS: Final = {("Color Transformer", "Automatic"): ""}
"""Values that RViz writes otherwise."""
_OUR_WORDS: Final = {("Color Transformer", ""): "Automatic", ("Position Transformer", ""): "XYZ"}
