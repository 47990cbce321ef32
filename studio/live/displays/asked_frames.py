"""AskedFrames: what pages ask about frames: where they are, and that one is followed."""

from __future__ import annotations

import asyncio
import time
from typing import TYPE_CHECKING, Final, Protocol

from studio.protocol.commands import Commands, Scope
from studio.protocol.displays import FollowFrame, FrameFollowed, GetTf, TfFrames
from studio.protocol.roles import Visitor

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.live.displays.scene_frames import SceneFrames
    from studio.protocol.listeners import Listener


class HasFrames(Protocol):
    """The scene that frames are of."""

    @property
    def frames(self) -> SceneFrames:
        """Its frames."""
        ...

    def follow(self, frame: str, now_ns: int, visitor: Visitor) -> str:
        """Keep a frame in the scene for a while; return why it cannot be, or an empty text."""
        ...


class AskedFrames:
    """Answers by TF, which is subscribed for a while after each question.

    Args:
        room: The scene, made when it is first needed.
        look: Has TF be subscribed for a while; returns whether it was not before.
    """

    def __init__(self, room: Callable[[], HasFrames], look: Callable[[], bool]) -> None:
        self._room, self._look = room, look

    async def tf(self, command: GetTf) -> TfFrames:
        """Return all frames, and the pose of one in another."""
        frames = await self.now(wait=not command.pose_only)
        if command.pose_only:
            return frames.answer(command, frames.fixed)
        # Thousands of frames as JSON take a while, and the loop has other work.
        return await asyncio.to_thread(frames.answer, command, frames.fixed)

    async def now(self, *, wait: bool) -> SceneFrames:
        """Return the frames of now.

        Args:
            wait: Whether the first transforms are waited for, if TF was not subscribed before.
        """
        is_first = self._look()
        frames = self._room().frames
        if is_first and wait:
            await frames.wait_for_first()
        frames.step()
        return frames

    def follow(self, command: FollowFrame, who: Listener) -> FrameFollowed:
        """Keep a frame in the scene for a camera to follow."""
        self._look()
        frame = command.frame.strip().removeprefix("/")
        trouble = self._room().follow(frame, time.time_ns(), Visitor(who.role, who.person))
        return FrameFollowed(request=command.request, trouble=trouble)


COMMANDS: Final = Commands[AskedFrames](Scope.DOCUMENT)
COMMANDS.viewer(GetTf, lambda frames, c, _: frames.tf(c))
COMMANDS.viewer(FollowFrame, lambda frames, c, who: frames.follow(c, who))
