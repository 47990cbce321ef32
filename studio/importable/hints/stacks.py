"""What the threads of a program are busy with, by their stacks: nothing is added to what runs."""

from __future__ import annotations

import sys
import threading
import time
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

from studio.importable.hints.said import is_users, place, place_of
from studio.ros.names import split_action_part
from studio.ros.node.base import NodeBase, was_spun
from studio.ros.node.executors import Executor, MultiThreadedExecutor
from studio.ros.node.service_client import Client

if TYPE_CHECKING:
    from collections.abc import Iterator
    from types import CodeType, FrameType

    from studio.importable.hints.said import Said

BLOCKED_S: Final = 2.0
"""A callback that runs longer keeps its node from all else for too long."""
CONSTRUCTING_S: Final = 5.0
UNSERVED_S: Final = 5.0
_AWAY_S: Final = 2.0
"""Whoever has not waited for so long does not wait any more."""
_CARRY_OUT: Final[CodeType] = Executor._carry_out.__code__  # pyright: ignore[reportPrivateUsage]
_WAIT: Final[CodeType] = Client.wait_for_service.__code__
_CALL: Final[CodeType] = Client.call.__code__


@dataclass
class _Busy:
    """A frame that was there at the last look, and since when; it is held, so that it stays it."""

    frame: FrameType
    since_s: float


@dataclass
class _Waiting:
    since_s: float
    last_s: float


class Stacks:
    """Looks at the stacks again and again, and says what has lasted too long."""

    def __init__(self, said: Said) -> None:
        self._said = said
        self._callbacks: dict[int, _Busy] = {}
        self._constructor: _Busy | None = None
        self._waiting: dict[str, _Waiting] = {}

    def look(self) -> None:
        """Look once; to be called every half second."""
        now_s = time.monotonic()
        main = threading.main_thread().ident
        own = threading.get_ident()
        callbacks: dict[int, _Busy] = {}
        for number, top in sys._current_frames().items():  # pyright: ignore[reportPrivateUsage]
            if number == own:
                continue
            frames = list(_frames(top))
            self._look_at_waiting(frames, now_s)
            if (found := _callback(frames)) is not None:
                callbacks[number] = self._kept(self._callbacks.get(number), found, now_s)
            if number == main:
                self._look_at_constructor(frames, now_s)
        self._callbacks = callbacks
        for busy in callbacks.values():
            if now_s - busy.since_s >= BLOCKED_S:
                self._say_blocked(busy)

    def _kept(self, before: _Busy | None, frame: FrameType, now_s: float) -> _Busy:
        return before if before is not None and before.frame is frame else _Busy(frame, now_s)

    def _say_blocked(self, busy: _Busy) -> None:
        frames = list(_inner_frames(busy.frame))
        executor = _executor_above(busy.frame)
        if isinstance(executor, MultiThreadedExecutor):
            return
        name, code = busy.frame.f_code.co_name, busy.frame.f_code
        inner = next((one for one in frames if is_users(one)), busy.frame)
        at = place(inner)
        client = next((one.f_locals.get("self") for one in frames if one.f_code is _CALL), None)
        if isinstance(client, Client):
            why = (
                f"waits at {at} for the answer of {client.endpoint.token.name}, which is taken "
                "only after it has returned: use call_async, and add a callback to the future"
            )
        else:
            why = (
                f"has run for {BLOCKED_S:.0f} s and is at {at}: until it returns, the node does "
                "nothing else; do a part of the work at each call of a timer, or give it a "
                "callback group of its own and spin with a MultiThreadedExecutor"
            )
        where = place_of(code.co_filename, code.co_firstlineno)
        self._said.say(f"blocked {where}", f"The callback {name} ({where}) {why}.")

    def _look_at_constructor(self, frames: list[FrameType], now_s: float) -> None:
        found = next((one for one in frames if _constructs(one)), None)
        if found is None or any(one.f_code is _WAIT for one in frames):
            self._constructor = None
            return
        self._constructor = busy = self._kept(self._constructor, found, now_s)
        node: Any = found.f_locals.get("self")
        if now_s - busy.since_s < CONSTRUCTING_S or not isinstance(node, NodeBase):
            return
        if was_spun(node):  # it spins within
            return
        inner = next((one for one in frames if is_users(one)), found)
        self._said.say(
            f"constructor {type(node).__name__}",
            f"The constructor of {type(node).__name__} has run for {CONSTRUCTING_S:.0f} s and is "
            f"at {place(inner)}: the node is not spun before it returns, so none of its callbacks "
            "is called; do in a timer what is repeated (self.create_timer).",
        )

    def _look_at_waiting(self, frames: list[FrameType], now_s: float) -> None:
        waits = next((one for one in frames if one.f_code is _WAIT), None)
        client: Any = waits.f_locals.get("self") if waits is not None else None
        if not isinstance(client, Client):
            return
        known = self._waiting.get(client.endpoint.token.name)
        if known is None or now_s - known.last_s > _AWAY_S:
            known = self._waiting[client.endpoint.token.name] = _Waiting(now_s, now_s)
        known.last_s = now_s
        if now_s - known.since_s >= UNSERVED_S:
            inner = next((one for one in frames if is_users(one)), None)
            self._say_unserved(client, place(inner) if inner is not None else "")

    def _say_unserved(self, client: Client, where: str) -> None:
        full = client.endpoint.token.name
        name, part = split_action_part(full) or (full, "")
        kind = "action" if part else "service"
        wanted = client.srv_type.name.removesuffix("_SendGoal") if part else client.srv_type.name
        at = f" at {where}" if where else ""
        self._said.say(
            f"unserved {name}",
            f"Nobody serves the {kind} {name} ({wanted}), for which the program waits{at}: start "
            f"the node that serves it{_instead(client, name, wanted)}.",
        )


def _instead(client: Client, name: str, wanted: str) -> str:
    """Return what is served of that name or that type, as an end of a sentence."""
    served = client.endpoint.graph().services()
    for other, types in served:
        if other == client.endpoint.token.name:
            return f", for {name} is served with another type, {types[0]}"
    for other, types in served:
        if wanted in types and not split_action_part(other):
            return f", or write {other}, which is served with that type"
    return ""


def _frames(top: FrameType) -> Iterator[FrameType]:
    """Yield a frame and those that called it."""
    frame: FrameType | None = top
    while frame is not None:
        yield frame
        frame = frame.f_back


def _callback(frames: list[FrameType]) -> FrameType | None:
    """Return the user's frame that an executor called; None for executions of actions, which last.

    The innermost executor counts: a program may spin within a callback.
    """
    found = None
    for frame in frames:
        if frame.f_code is _CARRY_OUT:
            return found
        if is_users(frame):
            found = frame
        elif "/ros/action/" in frame.f_code.co_filename:
            return None
    return None


def _inner_frames(outer: FrameType) -> Iterator[FrameType]:
    """Yield the frames of the thread that a frame belongs to, as far as that frame."""
    for top in sys._current_frames().values():  # pyright: ignore[reportPrivateUsage]
        frames = list(_frames(top))
        if outer in frames:
            yield from frames[: frames.index(outer) + 1]
            return


def _executor_above(frame: FrameType) -> object:
    above = frame.f_back
    while above is not None and above.f_code is not _CARRY_OUT:
        above = above.f_back
    return above.f_locals.get("self") if above is not None else None


def _constructs(frame: FrameType) -> bool:
    return (
        frame.f_code.co_name == "__init__"
        and is_users(frame)
        and isinstance(frame.f_locals.get("self"), NodeBase)
    )
