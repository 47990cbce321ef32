"""Errors about coordinate frames and the transforms between them."""

from __future__ import annotations

from studio.errors.root import StudioError


class FrameError(StudioError):
    """A frame is unknown, or nothing connects it with another."""


class UnknownFrameError(FrameError):
    """No transform has told of this frame."""

    def __init__(self, frame: str) -> None:
        super().__init__(f'No transform tells of the frame "{frame}": is its publisher running?')
        self.frame = frame


class UnconnectedFramesError(FrameError):
    """Two frames are in different trees, or in one that runs in a circle."""

    def __init__(self, target: str, source: str) -> None:
        super().__init__(
            f'No chain of transforms connects "{source}" with "{target}": '
            "publish the one that is missing between their trees."
        )
        self.target, self.source = target, source


class TransformError(FrameError):
    """A transform that was told is none."""

    def __init__(self, parent: str, child: str, reason: str) -> None:
        super().__init__(f'The transform from "{parent}" to "{child}" was left out: {reason}.')
        self.parent, self.child, self.reason = parent, child, reason
