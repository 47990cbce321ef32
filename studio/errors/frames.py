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

    def __init__(self, target: str, source: str, nearest: str | None = None) -> None:
        """`nearest` is the frame that everything around `source` hangs on, if one is known."""
        missing = "publish the one that is missing between their trees"
        if nearest == source:
            missing = f'publish where "{source}" is, which nothing tells'
        instead = "" if nearest is None else f', or look from "{nearest}" instead'
        super().__init__(
            f'No chain of transforms connects "{source}" with "{target}": {missing}{instead}.'
        )
        self.target, self.source, self.nearest = target, source, nearest


class ExtrapolationError(FrameError):
    """A pose was asked for at a time at which a transform on the way is not known.

    `frame` is the child of that transform; times are in ns of the clock of its stamps.
    """

    def __init__(self, frame: str, asked_ns: int, oldest_ns: int, newest_ns: int) -> None:
        if asked_ns > newest_ns:
            which, by_ns = "newer than the newest", asked_ns - newest_ns
            mend = "wait for its publisher, or compare its clock with that of the message"
        else:
            which, by_ns = "older than the oldest", oldest_ns - asked_ns
            mend = "send the message sooner, or compare its clock with that of the publisher"
        super().__init__(
            f"The stamp is {by_ns / 1e9:.3f} s {which} transform that is known of "
            f'"{frame}": {mend}.'
        )
        self.frame, self.asked_ns = frame, asked_ns
        self.oldest_ns, self.newest_ns = oldest_ns, newest_ns

    @property
    def may_come(self) -> bool:
        """Whether waiting can help: the stamp is newer than what is known."""
        return self.asked_ns > self.newest_ns


class TransformError(FrameError):
    """A transform that was told is none."""

    def __init__(self, parent: str, child: str, reason: str) -> None:
        super().__init__(f'The transform from "{parent}" to "{child}" was left out: {reason}.')
        self.parent, self.child, self.reason = parent, child, reason
