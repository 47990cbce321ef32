"""Errors of nodes: used before the wire was joined, after they were destroyed, or wrongly."""

from __future__ import annotations

from studio.errors.calls import CallError
from studio.errors.wire import WireError


class NodeError(WireError):
    """A node, or what carries out its work, cannot do what was asked."""


class NotJoinedError(NodeError):
    """A node was made, or work was asked for, before `init` or after `shutdown`."""

    def __init__(self) -> None:
        super().__init__(
            "The wire is not joined: call init() before a node is made, and shutdown() last."
        )


class AlreadyJoinedError(NodeError):
    """`init` was called twice."""

    def __init__(self) -> None:
        super().__init__("The wire is joined already: call init() once, or shutdown() before.")


class DestroyedError(NodeError):
    """Something was used after it was destroyed."""

    def __init__(self, what: str) -> None:
        super().__init__(f"The {what} was destroyed: make it again, or keep it longer.")
        self.what = what


class RosArgumentError(NodeError):
    """A word after `--ros-args` cannot be read."""

    def __init__(self, word: str, reason: str) -> None:
        super().__init__(f'The argument "{word[:200]}" is not understood: {reason}.')
        self.word, self.reason = word, reason


class OtherTypeError(NodeError):
    """A class of messages is not what its name means on the wire that it is used on."""

    def __init__(self, name: str, distro: str) -> None:
        super().__init__(
            f'The class "{name}" is not that of {distro}, or its text changed since it was '
            "imported: set ROS_DISTRO before it is imported, or import it anew."
        )
        self.name, self.distro = name, distro


class QosOverrideError(NodeError):
    """A parameter that overrides the QoS of a topic cannot be taken."""

    def __init__(self, name: str, reason: str) -> None:
        super().__init__(f'The parameter "{name[:200]}" overrides no QoS: {reason}.')
        self.name, self.reason = name, reason


class UnsupportedEventTypeError(NodeError):
    """A callback was given for an event that is never told on Zenoh."""

    def __init__(self, event: str) -> None:
        super().__init__(
            f"The event {event} is not told on Zenoh, nor by rmw_zenoh: leave its callback out."
        )
        self.event = event


class ExternalShutdownException(NodeError):  # noqa: N818  # the name that rclpy's users catch
    """The process was told to end while a node was spinning."""

    def __init__(self) -> None:
        super().__init__("The node was told to end.")


class CallRefusedError(CallError):
    """A server answered a request with an error, which nodes on rmw_zenoh never do."""

    def __init__(self, name: str, said: str) -> None:
        super().__init__(f'The service {name} refused the request: "{said}".')
        self.name, self.said = name, said


class ForeignAnswerError(CallError):
    """A server answered a request as no node on rmw_zenoh does."""

    def __init__(self, name: str, reason: str) -> None:
        super().__init__(
            f"An answer of the service {name} was dropped: {reason}; its node is to repeat number "
            "and sender of the request."
        )
        self.name, self.reason = name, reason
