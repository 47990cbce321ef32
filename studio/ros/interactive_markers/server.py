"""InteractiveMarkerServer: markers that people move in RViz or in the studio."""

from __future__ import annotations

import copy
import threading
import time
from dataclasses import dataclass, field
from enum import Enum, auto
from typing import TYPE_CHECKING, Final, Self, TypeAlias

from studio.ros.interactive_markers.names import (
    DEPTH,
    FEEDBACK,
    FEEDBACK_TOPIC,
    POSE,
    SERVICE,
    SERVICE_NAME,
    UPDATE,
    UPDATE_TOPIC,
    FeedbackEvent,
    UpdateKind,
)

if TYPE_CHECKING:
    from collections.abc import Callable
    from types import TracebackType

    from studio.ros.node.node import Node
    from studio.ros.types.classes import MessageValue

FeedbackCallback: TypeAlias = "Callable[[MessageValue], object]"
"""Is called with an InteractiveMarkerFeedback."""
_HELD_S: Final = 1.0
"""For so long after a client's feedback, that of others about the same marker is ignored."""


@dataclass(slots=True)
class _Callbacks:
    """Who is called for the feedback about one marker."""

    default: FeedbackCallback | None = None
    of_type: dict[int, FeedbackCallback] = field(default_factory=dict[int, FeedbackCallback])

    def set(self, callback: FeedbackCallback | None, feedback_type: int) -> None:
        if feedback_type == InteractiveMarkerServer.DEFAULT_FEEDBACK_CALLBACK:
            self.default = callback
        elif callback is None:
            self.of_type.pop(feedback_type, None)
        else:
            self.of_type[feedback_type] = callback


@dataclass(slots=True)
class _Marker:
    """A marker that clients know."""

    message: MessageValue
    callbacks: _Callbacks
    last_client_id: str = ""
    last_feedback_s: float = float("-inf")


class _Change(Enum):
    """What the next update says of a marker."""

    FULL = auto()
    POSE = auto()
    ERASE = auto()


@dataclass(slots=True)
class _Pending:
    """A change that was not published yet.

    Attributes:
        change: Its kind.
        message: The marker of a full change; an InteractiveMarkerPose of one of the pose.
        callbacks: For a marker that clients do not know yet.
    """

    change: _Change
    message: MessageValue
    callbacks: _Callbacks = field(default_factory=_Callbacks)


class InteractiveMarkerServer:
    """Shows markers to its clients, and calls back with what people do to them.

    Nothing changes for clients before `apply_changes`, which publishes all changes as one update.
    Methods may be called from callbacks and from any thread. Markers are copied on the way in and
    out. ROS 2's servers do not say all the time that they live: a client sees it by the service.

    Args:
        node: Publishes, subscribes and serves below `topic_ns`.
        topic_ns: Namespace of `update`, `feedback` and `get_interactive_markers`.
        q_size: Depth of both topics.

    Raises:
        RosNameError: Nothing can be named so.
    """

    DEFAULT_FEEDBACK_CALLBACK: Final = 255

    def __init__(self, node: Node, topic_ns: str, q_size: int = DEPTH) -> None:
        self.node, self.topic_ns = node, topic_ns
        self.seq_num = 0
        """Number of the last update."""
        types = node.wire.types
        self._update, self._pose = types.message(UPDATE), types.message(POSE)
        self._markers: dict[str, _Marker] = {}
        self._pending: dict[str, _Pending] = {}
        self._lock = threading.RLock()
        self._service = node.create_service(
            types.service(SERVICE), topic_ns + SERVICE_NAME, self._answer
        )
        self._publisher = node.create_publisher(self._update, topic_ns + UPDATE_TOPIC, q_size)
        self._subscription = node.create_subscription(
            types.message(FEEDBACK), topic_ns + FEEDBACK_TOPIC, self.process_feedback, q_size
        )
        self._is_shut_down = False

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.shutdown()

    def __len__(self) -> int:
        """Count the markers that clients know."""
        return len(self._markers)

    def shutdown(self) -> None:
        """Erase all markers and end; a second time does nothing. Call it before the node ends."""
        if self._is_shut_down:
            return
        self._is_shut_down = True
        self.clear()
        self.apply_changes()
        self.node.destroy_service(self._service)
        self.node.destroy_subscription(self._subscription)
        self.node.destroy_publisher(self._publisher)

    def insert(
        self,
        marker: MessageValue,
        *,
        feedback_callback: FeedbackCallback | None = None,
        feedback_type: int = DEFAULT_FEEDBACK_CALLBACK,
    ) -> None:
        """Add a marker, or replace the one of its name; a callback counts at once."""
        with self._lock:
            pending = self._pending.setdefault(marker.name, _Pending(_Change.FULL, marker))
            pending.change, pending.message = _Change.FULL, copy.deepcopy(marker)
            if feedback_callback is not None:
                self.set_callback(marker.name, feedback_callback, feedback_type)

    def set_pose(self, name: str, pose: MessageValue, header: MessageValue | None = None) -> bool:
        """Move a marker; with a header that names a frame, into that frame.

        Returns:
            Whether there is a marker of that name.
        """
        with self._lock:
            known, pending = self._markers.get(name), self._pending.get(name)
            if pending is not None and pending.change is _Change.FULL:
                before = pending.message
            elif known is not None:
                before = known.message
            else:
                return False
            is_elsewhere = header is not None and header.frame_id
            self._set_pose(name, pose, header if header and is_elsewhere else before.header)
            return True

    def erase(self, name: str) -> bool:
        """Remove a marker; whether there is one of that name."""
        with self._lock:
            if name not in self._markers and name not in self._pending:
                return False
            self._pending[name] = self._erasure()
            return True

    def clear(self) -> None:
        """Remove all markers."""
        with self._lock:
            self._pending = {name: self._erasure() for name in self._markers}

    def set_callback(
        self,
        name: str,
        feedback_callback: FeedbackCallback | None,
        feedback_type: int = DEFAULT_FEEDBACK_CALLBACK,
    ) -> bool:
        """Have a function called with feedback of a type, or with all that no other one takes.

        Args:
            name: Of the marker.
            feedback_callback: None: nobody is called any more.
            feedback_type: As `InteractiveMarkerFeedback.MENU_SELECT`.

        Returns:
            Whether there is a marker of that name.
        """
        with self._lock:
            known, pending = self._markers.get(name), self._pending.get(name)
            for one in (known, pending):
                if one is not None:
                    one.callbacks.set(feedback_callback, feedback_type)
            return known is not None or pending is not None

    def apply_changes(self) -> None:
        """Publish all changes since the last call as one update; without any, nothing is sent."""
        with self._lock:
            if not self._pending:
                return
            update = self._update(type=int(UpdateKind.UPDATE))
            pending, self._pending = self._pending, {}
            for name, one in pending.items():
                self._apply(name, one, update)
            self.seq_num += 1
            update.seq_num = self.seq_num
            self._publisher.publish(update)

    def get(self, name: str) -> MessageValue | None:
        """Return a copy of a marker as it will be after `apply_changes`; None: there is none."""
        with self._lock:
            known, pending = self._markers.get(name), self._pending.get(name)
            if pending is None:
                return None if known is None else copy.deepcopy(known.message)
            match pending.change:
                case _Change.ERASE:
                    return None
                case _Change.FULL:
                    return copy.deepcopy(pending.message)
                case _Change.POSE:
                    if known is None:
                        return None
                    marker = copy.deepcopy(known.message)
                    marker.pose = copy.deepcopy(pending.message.pose)
                    marker.header = copy.deepcopy(pending.message.header)
                    return marker

    def process_feedback(self, feedback: MessageValue) -> None:
        """Take the new pose of a marker from a client, and call who waits for that.

        Of two clients that move one marker, the one that began is heard until it is silent for a
        second.
        """
        with self._lock:
            known = self._markers.get(feedback.marker_name)
            if known is None:
                return
            now_s = time.monotonic()
            if (
                known.last_client_id != feedback.client_id
                and now_s - known.last_feedback_s < _HELD_S
            ):
                return
            known.last_feedback_s, known.last_client_id = now_s, feedback.client_id
            if feedback.event_type == FeedbackEvent.POSE_UPDATE:
                stamp = known.message.header.stamp
                keeps = stamp.sec == 0 and stamp.nanosec == 0
                header = known.message.header if keeps else feedback.header
                self._set_pose(feedback.marker_name, feedback.pose, header)
            callbacks = known.callbacks
            callback = callbacks.of_type.get(feedback.event_type, callbacks.default)
        if callback is not None:
            callback(feedback)

    def _erasure(self) -> _Pending:
        return _Pending(_Change.ERASE, self._pose())

    def _set_pose(self, name: str, pose: MessageValue, header: MessageValue) -> None:
        pending = self._pending.get(name)
        if pending is None or pending.change is _Change.ERASE:
            pending = self._pending[name] = _Pending(_Change.POSE, self._pose(name=name))
        pending.message.pose, pending.message.header = copy.deepcopy(pose), copy.deepcopy(header)

    def _apply(self, name: str, pending: _Pending, update: MessageValue) -> None:
        """Make one change, and write it into the update."""
        known = self._markers.get(name)
        match pending.change:
            case _Change.FULL:
                if known is None:
                    self._markers[name] = _Marker(pending.message, pending.callbacks)
                else:
                    known.message = pending.message
                update.markers.append(pending.message)
            case _Change.POSE if known is not None:
                known.message.pose = pending.message.pose
                known.message.header = pending.message.header
                update.poses.append(pending.message)
            case _Change.ERASE if known is not None:
                del self._markers[name]
                update.erases.append(name)
            case _:
                pass

    def _answer(self, request: object, response: MessageValue) -> MessageValue:
        del request
        with self._lock:
            response.sequence_number = self.seq_num
            response.markers = [copy.deepcopy(one.message) for one in self._markers.values()]
        return response

    # The names of interactive_markers' own Python server, so that its programs run.
    setPose = set_pose  # noqa: N815
    setCallback = set_callback  # noqa: N815
    applyChanges = apply_changes  # noqa: N815
    processFeedback = process_feedback  # noqa: N815
