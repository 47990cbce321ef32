"""What the presenter looks at, for all who follow: camera and pointer, selection and panel."""

from __future__ import annotations

import math
import struct
from typing import TYPE_CHECKING, Final, NamedTuple, TypeAlias

from studio.protocol.classroom import Focus, Gather, Leading
from studio.protocol.listeners import Audience, encode, send
from studio.protocol.roles import RELAY

if TYPE_CHECKING:
    from collections.abc import Iterable

    from studio.protocol.listeners import Listener

Point: TypeAlias = "tuple[float, float, float]"
VIEW: Final = 2
"""First byte of the frame; 1 are joints."""
_FRAME: Final = struct.Struct("<BB6x13f")
_NOWHERE: Final = (math.nan,) * 3
_KEY, _FOCUS_KEY = "view", "focus"


class Seen(NamedTuple):
    """Camera and pointer of the presenter, in m in the root frame."""

    eye: Point
    target: Point
    pointer: Point | None
    """What the mouse points at; None: nothing."""
    up: Point = (0.0, 0.0, 1.0)
    flat: bool = False
    """Whether without perspective."""
    field_rad: float = math.pi / 4


class Following:
    """Used on the event loop only."""

    def __init__(self) -> None:
        self.leading = True
        self._followers: dict[Listener, None] = {}
        self._shown_elsewhere: set[Listener] = set()
        """Pages at relays that follow: the relay shows it to them."""
        self._everybody = Audience()
        self._leader: Listener | None = None
        """Whose view was shown last."""
        self._view = b""
        self._focus: Focus | None = None

    def attach(self, listener: Listener) -> None:
        """Tell a new page whether the presenter leads."""
        self._everybody.add(listener)
        send(listener, Leading(leading=self.leading))

    def detach(self, listener: Listener) -> None:
        """Forget a page."""
        self._everybody.remove(listener)
        self._followers.pop(listener, None)
        self._shown_elsewhere.discard(listener)
        if self._leader is listener:  # who comes now is not taken to where it was
            self._forget()

    def lead(self, *, leading: bool) -> None:
        """Show others what the presenter looks at, or no longer."""
        self.leading = leading
        if not leading:
            self._forget()
        self._everybody.send(Leading(leading=leading))

    def _forget(self) -> None:
        self._view, self._focus, self._leader = b"", None, None
        for page in self._followers:
            if page.person == RELAY:  # it keeps them for who comes later
                page.post(b"", binary=True, key=_KEY)
                page.post(b"", binary=True, key=_FOCUS_KEY)

    def gather(self, document: str = "") -> None:
        """Bring everybody to what the presenter looks at, or first to a document."""
        self.lead(leading=True)
        self._everybody.send(Gather(document=document))
        if document:
            self._show(Focus(document=document, part="", site="", panel=""), self._followers)

    def follow(self, listener: Listener, *, following: bool) -> bool:
        """Show a page what the presenter looks at, or no longer; return whether that is new."""
        is_new = following != self.is_following(listener)
        if listener not in self._everybody:
            (self._shown_elsewhere.add if following else self._shown_elsewhere.discard)(listener)
            return is_new
        if not following:
            self._followers.pop(listener, None)
            return is_new
        self._followers[listener] = None
        if self._focus is not None and not listener.sees(self._focus.document):
            return is_new
        if self._focus is not None:
            listener.post(encode(self._focus), key=_FOCUS_KEY)
        if self._view:
            listener.post(self._view, binary=True, key=_KEY)
        return is_new

    def is_following(self, listener: Listener) -> bool:
        """Whether a page follows."""
        return listener in self._followers or listener in self._shown_elsewhere

    def show_view(self, leader: Listener, document: str, seen: Seen) -> None:
        """Show camera and pointer to all who follow.

        Args:
            leader: The page that shows.
            document: What it shows.
            seen: Camera and pointer.
        """
        if not self.leading:
            return
        self._leader = leader
        pointer = seen.pointer or _NOWHERE
        numbers = (*seen.eye, *seen.target, *pointer, *seen.up, seen.field_rad)
        self._view = _FRAME.pack(VIEW, seen.flat, *numbers)
        for page in self._others(leader, document):
            page.post(self._view, binary=True, key=_KEY)

    def show_focus(self, leader: Listener, focus: Focus) -> None:
        """Show what is selected, pointed at and open to all who follow."""
        if not self.leading:
            return
        self._leader = leader
        self._show(focus, self._others(leader, focus.document))

    def _show(self, focus: Focus, pages: Iterable[Listener]) -> None:
        self._focus = focus
        data = encode(focus)
        for page in pages:
            page.post(data, key=_FOCUS_KEY)

    def _others(self, leader: Listener, document: str) -> list[Listener]:
        """Return those who follow: to a copy that is not shown to them they are not taken."""
        return [page for page in self._followers if page is not leader and page.sees(document)]
