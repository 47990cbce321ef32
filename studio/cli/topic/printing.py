"""Messages as `topic echo` prints them."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from studio.cli.topic.field_path import field_at, field_text
from studio.ros.types.classes import MessageValue
from studio.ros.types.convert import Brevity, to_csv, to_yaml

if TYPE_CHECKING:
    import argparse

    from studio.ros.node.samples import MessageInfo
    from studio.ros.node.subscription import Losses

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
        self._said_lost = 0

    def text(self, message: MessageValue | bytes, info: MessageInfo) -> str:
        """Write a message, without the end of its last line.

        Raises:
            MessageValueError: It has no such field as `--field` names.
        """
        head = f"{_info_text(info)}\n" if self._options.include_message_info else ""
        if not isinstance(message, MessageValue):
            return f"{head}{message!r}\n{_END}"
        return head + self._message(message)

    def say_lost(self, losses: Losses) -> None:
        """Say on stderr that messages were lost, and why, when that is news."""
        lost = losses.lost + losses.overwritten
        broken = losses.refused + losses.malformed
        if lost + broken <= self._said_lost:
            return
        self._said_lost = lost + broken
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
