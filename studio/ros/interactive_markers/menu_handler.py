"""MenuHandler: a menu that is put on markers, and the functions that its entries call."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final, TypeAlias

from studio.ros.interactive_markers.names import MENU_ENTRY, CommandKind, FeedbackEvent

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from studio.ros.interactive_markers.server import InteractiveMarkerServer
    from studio.ros.types.classes import MessageValue

MenuCallback: TypeAlias = "Callable[[MessageValue], object]"
"""Is called with the InteractiveMarkerFeedback of a click."""


@dataclass(slots=True)
class _Entry:
    title: str
    command_type: int
    command: str
    callback: MenuCallback | None
    visible: bool = True
    check_state: int = 0
    below: list[int] = field(default_factory=list[int])
    """Handles of the entries of its submenu."""


class MenuHandler:
    """Builds a menu and puts it on markers; a click calls the function of its entry.

    Entries are known by handles, from 1. What is changed is seen after `apply` or `re_apply`, and
    the server's `apply_changes`.
    """

    NO_CHECKBOX: Final = 0
    CHECKED: Final = 1
    UNCHECKED: Final = 2
    _MARKS: Final = {NO_CHECKBOX: "", CHECKED: "[x] ", UNCHECKED: "[ ] "}

    def __init__(self) -> None:
        self._entries: dict[int, _Entry] = {}
        self._top: list[int] = []
        self._managed: dict[str, None] = {}
        """Names of markers that it was put on, in this order."""

    def insert(
        self,
        title: str,
        parent: int | None = None,
        command_type: int = CommandKind.FEEDBACK,
        command: str = "",
        callback: MenuCallback | None = None,
    ) -> int | None:
        """Add an entry at the end of the menu, or of the submenu of `parent`.

        Returns:
            Its handle; None: there is no such parent.
        """
        if parent is None:
            beside = self._top
        elif parent in self._entries:
            beside = self._entries[parent].below
        else:
            return None
        handle = len(self._entries) + 1
        self._entries[handle] = _Entry(title, int(command_type), command, callback)
        beside.append(handle)
        return handle

    def set_visible(self, handle: int, visible: bool) -> bool:  # noqa: FBT001 - as upstream
        """Show or hide an entry and its submenu; whether there is one of that handle."""
        entry = self._entries.get(handle)
        if entry is not None:
            entry.visible = visible
        return entry is not None

    def set_check_state(self, handle: int | None, check_state: int) -> bool:
        """Check or uncheck an entry, or take its box away; whether there is one."""
        entry = None if handle is None else self._entries.get(handle)
        if entry is not None:
            entry.check_state = check_state
        return entry is not None

    def get_check_state(self, handle: int) -> int | None:
        """Return the state of an entry's box; None: there is no such entry."""
        entry = self._entries.get(handle)
        return None if entry is None else entry.check_state

    def get_title(self, handle: int) -> str | None:
        """Return the title of an entry; None: there is no such entry."""
        entry = self._entries.get(handle)
        return None if entry is None else entry.title

    def apply(self, server: InteractiveMarkerServer, marker_name: str) -> bool:
        """Put the menu on a marker; whether the server has it. Its clicks call this menu."""
        marker = server.get(marker_name)
        if marker is None:
            self._managed.pop(marker_name, None)
            return False
        kind = server.node.wire.types.message(MENU_ENTRY)
        marker.menu_entries = [
            kind(id=handle, parent_id=parent, **self._fields(self._entries[handle]))
            for handle, parent in self._visible(self._top, 0)
        ]
        server.insert(
            marker,
            feedback_callback=self.process_feedback,
            feedback_type=FeedbackEvent.MENU_SELECT,
        )
        self._managed[marker_name] = None
        return True

    def re_apply(self, server: InteractiveMarkerServer) -> bool:
        """Put the menu again on all markers that have it; whether all of them are still there."""
        applied = [self.apply(server, name) for name in tuple(self._managed)]
        return all(applied)

    def process_feedback(self, feedback: MessageValue) -> None:
        """Call the function of the entry that was clicked."""
        entry = self._entries.get(feedback.menu_entry_id)
        if entry is not None and entry.callback is not None:
            entry.callback(feedback)

    def _visible(self, handles: Iterable[int], parent: int) -> Iterator[tuple[int, int]]:
        """Yield the entries to show with their parents, parents first."""
        for handle in handles:
            if self._entries[handle].visible:
                yield handle, parent
                yield from self._visible(self._entries[handle].below, handle)

    def _fields(self, entry: _Entry) -> dict[str, Any]:
        return {
            "title": self._MARKS.get(entry.check_state, "") + entry.title,
            "command": entry.command,
            "command_type": entry.command_type,
        }

    # The names of interactive_markers' own Python module, so that its programs run.
    setVisible = set_visible  # noqa: N815
    setCheckState = set_check_state  # noqa: N815
    getCheckState = get_check_state  # noqa: N815
    getTitle = get_title  # noqa: N815
    reApply = re_apply  # noqa: N815
    processFeedback = process_feedback  # noqa: N815
