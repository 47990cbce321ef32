"""What a page asked for that lasts: the studio forgets it with the line, and is asked again."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from studio.protocol.classroom import Follow
from studio.protocol.lessons import CloseLesson, OpenLesson, SawPanel
from studio.protocol.parameters import FollowParameters

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.protocol import Command
    from studio.protocol.listeners import Listener

_PANELS_MAX: Final = 100
_LESSON, _PANEL, _FOLLOW, _PARAMETERS = "lesson", "panel ", "follow", "parameters"


class Standing:
    """By page; used on the event loop only."""

    def __init__(self) -> None:
        self._pages: dict[Listener, dict[str, Command]] = {}

    def note(self, command: Command, page: Listener) -> None:
        """Keep a command if it lasts, in the place of the one before; or end what it ends."""
        kept = self._pages.get(page, {})
        match command:
            case OpenLesson():
                self._pages[page] = {_LESSON: command} | _without_lesson(kept)
            case CloseLesson():
                self._pages[page] = _without_lesson(kept)
            case SawPanel() if _LESSON in kept and len(kept) < _PANELS_MAX:
                kept[_PANEL + command.panel] = command
            case Follow(following=True):
                self._pages[page] = kept | {_FOLLOW: command}
            case Follow():
                kept.pop(_FOLLOW, None)
            case FollowParameters() if command.node:
                self._pages[page] = kept | {_PARAMETERS: command}
            case FollowParameters():
                kept.pop(_PARAMETERS, None)
            case _:
                pass

    def forget(self, page: Listener) -> None:
        """A page was closed."""
        self._pages.pop(page, None)

    def of(self, page: Listener) -> Iterator[Command]:
        """Give what a page asked for and did not end meanwhile, without its number and id."""
        for name, command in tuple(self._pages.get(page, {}).items()):
            if self._pages.get(page, {}).get(name) is command:
                yield command.model_copy(update={"request": 0, "id": ""})


def _without_lesson(kept: dict[str, Command]) -> dict[str, Command]:
    return {
        name: one for name, one in kept.items() if name != _LESSON and not name.startswith(_PANEL)
    }
