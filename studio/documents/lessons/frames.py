"""Which frame hangs on which in a ROS system: all that a check of TF asks."""

from __future__ import annotations

import threading
import time
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from studio.errors import CdrError
from studio.ros.client import DurabilityPolicy, QoSProfile
from studio.ros.columns.transforms import TransformCodec
from studio.tf.transforms import plain_name

if TYPE_CHECKING:
    from studio.live.connection.link import WireLink
    from studio.ros.node.subscription import Subscription

FRAMES_MAX: Final = 2_000
"""Frames beyond these are left out; a student may send any number of names."""
_GONE_S: Final = 10.0
"""A frame of /tf that did not come for so long is gone, as in tf2's buffer."""


@dataclass(frozen=True, slots=True)
class _Edge:
    parent: str
    static: bool
    at_s: float


class Frames:
    """Listens to /tf and /tf_static; safe to ask in any thread."""

    def __init__(self, link: WireLink) -> None:
        self._codec, self._node = TransformCodec(), link.node
        self._lock = threading.Lock()
        self._edges: dict[str, _Edge] = {}
        """By child."""
        self.asked_s = time.monotonic()
        node, kind = link.node, link.types.message("tf2_msgs/msg/TFMessage")
        kept = QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self._subscriptions: list[Subscription] = [
            node.create_subscription(kind, "/tf_static", self._take_static, kept, raw=True),
            node.create_subscription(kind, "/tf", self._take, 100, raw=True),
        ]

    def close(self) -> None:
        """Listen no more."""
        for one in self._subscriptions:
            self._node.destroy_subscription(one)

    def _take_static(self, data: bytes) -> None:
        self._put(data, static=True)

    def _take(self, data: bytes) -> None:
        self._put(data, static=False)

    def _put(self, data: bytes, *, static: bool) -> None:
        try:
            columns = self._codec.decode(data)
        except CdrError:
            return  # the Frames panel says so
        now_s = time.monotonic()
        with self._lock:
            for parent, child in zip(columns.parents, columns.children, strict=True):
                name = plain_name(child)
                if name in self._edges or len(self._edges) < FRAMES_MAX:
                    self._edges[name] = _Edge(plain_name(parent), static, now_s)

    def root_of(self, frame: str, *, has_static: bool) -> str | None:
        """Return the frame that a frame hangs on in the end, itself perhaps; None: it is unknown.

        Args:
            frame: With a leading slash or without.
            has_static: Whether anybody publishes /tf_static; else what came of it is forgotten.
        """
        self.asked_s = now_s = time.monotonic()
        name = plain_name(frame)
        with self._lock:
            self._edges = {
                child: one
                for child, one in self._edges.items()
                if (has_static if one.static else now_s - one.at_s < _GONE_S)
            }
            if name not in self._edges and all(one.parent != name for one in self._edges.values()):
                return None
            passed = {name}
            while (edge := self._edges.get(name)) and edge.parent not in passed:
                name = edge.parent
                passed.add(name)
        return name
