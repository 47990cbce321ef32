"""Tells pages that something changed of which they ask, a few times a second at most."""

from __future__ import annotations

import asyncio
from functools import partial
from typing import TYPE_CHECKING, Final

from studio.debounce import Throttle
from studio.protocol.changes import Changed, FollowChanges, Subject
from studio.protocol.commands import Commands, Scope
from studio.protocol.listeners import Audience

if TYPE_CHECKING:
    from studio.protocol.listeners import Listener

_PAUSES_S: Final[dict[Subject, float]] = {
    "graph": 0.5,
    "log": 0.2,
    "diagnostics": 0.5,
    "goal_statuses": 0.5,
    "lessons": 0.2,
    "lesson_list": 0.5,
    "ticks": 0.5,
    "workspaces": 0.5,
    "runs": 0.2,
}


class Changes:
    """Keeps who follows which subject; used on the event loop but for `changed_elsewhere`."""

    def __init__(self) -> None:
        self._followers: dict[Subject, Audience] = {one: Audience() for one in _PAUSES_S}
        self._throttles: dict[Subject, Throttle] = {
            one: Throttle(partial(self._send, one), pause_s=pause_s)
            for one, pause_s in _PAUSES_S.items()
        }
        self._loop: asyncio.AbstractEventLoop | None = None
        self._woken: set[Subject] = set()
        self._closed = False

    def follow(self, command: FollowChanges, listener: Listener) -> None:
        """Send a page the changes of a subject from now on, or no more."""
        self._loop = asyncio.get_running_loop()
        if command.following:
            self._followers[command.subject].add(listener)
        else:
            self._followers[command.subject].remove(listener)

    def detach(self, listener: Listener) -> None:
        """Forget a page."""
        for followers in self._followers.values():
            followers.remove(listener)

    def is_followed(self, subject: Subject) -> bool:
        """Return whether a page follows the changes of a subject."""
        return bool(self._followers[subject])

    def all_changed(self) -> None:
        """Notify all followers soon: their answers were of another connection."""
        for subject in _PAUSES_S:
            self.changed(subject)

    def changed(self, subject: Subject) -> None:
        """Notify the followers of a subject soon."""
        if self._followers[subject] and not self._closed:
            self._throttles[subject].trigger()

    def changed_elsewhere(self, subject: Subject) -> None:
        """Do the same, thread-safe."""
        loop = self._loop
        if (
            self._followers[subject]
            and subject not in self._woken
            and loop
            and not loop.is_closed()
        ):
            self._woken.add(subject)
            loop.call_soon_threadsafe(self._wake, subject)

    async def close(self) -> None:
        """Send nothing more."""
        self._closed = True
        await asyncio.gather(*(one.close() for one in self._throttles.values()))

    def _wake(self, subject: Subject) -> None:
        self._woken.discard(subject)  # before sending: what changes from now on is sent again
        self.changed(subject)

    async def _send(self, subject: Subject) -> None:
        self._followers[subject].send(Changed(subject=subject))


COMMANDS: Final = Commands[Changes](Scope.ROS)
COMMANDS.viewer(FollowChanges, lambda one, c, who: one.follow(c, who))
