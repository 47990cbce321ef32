"""A message, or one field of it by its path, as `ros2 topic echo` prints it."""

from __future__ import annotations

import re
import sys
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from studio.errors import MessageValueError
from studio.ros.types.classes import MessageValue, attribute_name, definition_of
from studio.ros.types.convert import WHOLE, Brevity, to_csv, to_yaml

if TYPE_CHECKING:
    import argparse
    from collections.abc import Sequence

    from studio.ros.node.samples import MessageInfo
    from studio.ros.node.subscription import Losses


_PART = re.compile(r"(\w+)((?:\[-?\d+\])*)", re.ASCII)
_INDEX_DIGITS_MAX = 10


def field_at(message: MessageValue, path: str) -> object:
    """Find a field of a message, of the messages therein, or a place of an array.

    Raises:
        MessageValueError: There is no such field or place.
    """
    found: object = message
    for part in path.split("."):
        match = _PART.fullmatch(part)
        if match is None:
            raise MessageValueError(path, f'"{part}" is no name of a field')
        found = _field(found, match[1], path)
        for index in re.findall(r"-?\d+", match[2]):
            found = _place(found, index, path)
    return found


def field_text(value: object, brevity: Brevity = WHOLE) -> str:
    """Write what a path led to, as `ros2 topic echo --field` does: YAML, or the value alone."""
    if isinstance(value, MessageValue):
        return to_yaml(value, brevity).rstrip("\n")
    if isinstance(value, np.ndarray):
        return _list_text(cast("Any", value).tolist(), brevity)
    if isinstance(value, list):
        return _list_text(cast("list[object]", value), brevity)
    return str(value)


def _field(value: object, name: str, path: str) -> object:
    if not isinstance(value, MessageValue):
        raise MessageValueError(path, f'nothing is named "{name}" in a plain value')
    names = [field.name for field in definition_of(value).fields]
    if name not in names:
        kind = definition_of(value).name
        raise MessageValueError(path, f'{kind} has no field "{name}", its fields: {names}')
    return getattr(value, attribute_name(name))


def _place(value: object, index: str, path: str) -> object:
    if len(index) > _INDEX_DIGITS_MAX or not isinstance(value, (list, np.ndarray)):
        raise MessageValueError(path, f"[{index[:20]}] is no place in it")
    places = cast("Sequence[object]", value)
    if not -len(places) <= int(index) < len(places):
        raise MessageValueError(path, f"it has {len(places)} places, [{index}] is none of them")
    return places[int(index)]


def _list_text(values: list[Any], brevity: Brevity) -> str:
    if brevity.no_arrays:
        return f"<sequence, length: {len(values)}>"
    limit = len(values) if brevity.length_max is None else brevity.length_max
    texts = [
        "{" + to_yaml(one, brevity, flow=True).strip().removeprefix("{").removesuffix("}") + "}"
        if isinstance(one, MessageValue)
        else repr(one)
        for one in values[:limit]
    ]
    return f"[{', '.join([*texts, *(['...'] if len(values) > limit else [])])}]"


_END = "---"


class Printing:
    """How one `echo` prints, by its options."""

    def __init__(self, options: argparse.Namespace) -> None:
        self._options = options
        self._brevity = Brevity(
            no_arrays=options.no_arr,
            no_texts=options.no_str,
            length_max=None if options.full_length else options.truncate_length,
        )
        self._printed_lost = 0

    def text(self, message: MessageValue | bytes, info: MessageInfo) -> str:
        """Write a message, without the end of its last line.

        Raises:
            MessageValueError: It has no such field as `--field` names.
        """
        head = f"{_info_text(info)}\n" if self._options.include_message_info else ""
        if not isinstance(message, MessageValue):
            return f"{head}{message!r}\n{_END}"
        return head + self._message(message)

    def print_lost(self, losses: Losses) -> None:
        """Print on stderr that more messages were lost, and why."""
        lost = losses.lost + losses.overwritten
        broken = losses.refused + losses.malformed
        if lost + broken <= self._printed_lost:
            return
        self._printed_lost = lost + broken
        if broken:
            print(f"{broken} messages could not be read: {losses.reason}", file=sys.stderr)
        if lost:
            print(f"A message was lost!!!\n\ttotal count: {lost}", file=sys.stderr)

    def _message(self, message: MessageValue) -> str:
        shown = message
        if self._options.field is not None:
            shown = field_at(message, self._options.field)
        if self._options.csv:
            return self._line(shown)
        if isinstance(shown, MessageValue):
            flow = self._options.flow_style
            return to_yaml(shown, self._brevity, flow=flow).rstrip("\n") + f"\n{_END}"
        return f"{field_text(shown, self._brevity)}\n{_END}"

    def _line(self, shown: object) -> str:
        if isinstance(shown, MessageValue):
            return to_csv(shown, self._brevity)
        text = field_text(shown, self._brevity)
        return text.removeprefix("[").removesuffix("]").replace(", ", ",")


def _info_text(info: MessageInfo) -> str:
    return str({name: value for name, value in info.items() if value is not None})
