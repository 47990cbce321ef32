"""A real node that tells what the samples of the displays are about."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING

from studio.nodes.robot_state_publisher import LATCHED
from studio.ros.interactive_markers import InteractiveMarkerServer
from studio.ros.interactive_markers.names import Mode
from studio.ros.messages import message
from studio.ros.types.convert import from_dict
from tests.support.demos import node_at
from tests.support.display_messages import pose
from tests.support.display_samples import FRAMES, headed
from tests.support.interactive_markers import moving_marker

if TYPE_CHECKING:
    from collections.abc import Generator, Iterable

    from studio.ros.client import Node
    from tests.support.display_samples import Fields, Sample

_PERIOD_S = 0.3


@contextmanager
def told(endpoint: str, samples: Iterable[Sample]) -> Generator[None]:
    """A node tells of all samples and of their frames, again and again."""
    with node_at(endpoint, "teller") as node:
        _tell_frames(node)
        for one in samples:
            for topic, (type_name, fields) in one.messages().items():
                _tell(node, topic, type_name, one.frame, fields)
            if one.kind == "InteractiveMarkers":
                _serve_markers(node, str(one.values["Interactive Markers Namespace"]), one.frame)
        yield


def _tell_frames(node: Node) -> None:
    kind = message("tf2_msgs/msg/TFMessage")
    rows = [
        {
            "header": {"frame_id": parent},
            "child_frame_id": child,
            "transform": {"translation": at["position"], "rotation": at["orientation"]},
        }
        for parent, child, xyz, wxyz in FRAMES
        for at in (pose(xyz, wxyz),)
    ]
    publisher = node.create_publisher(kind, "/tf_static", LATCHED)
    publisher.publish(from_dict(kind, {"transforms": rows}))


def _serve_markers(node: Node, namespace: str, frame: str) -> None:
    server = InteractiveMarkerServer(node, namespace)
    modes = (Mode.ROTATE_AXIS, Mode.MOVE_AXIS, Mode.MENU)
    marker = moving_marker(node.wire.types, "handle", modes, frame)
    marker.pose.position.z = 1.0
    server.insert(marker)
    server.apply_changes()


def _tell(node: Node, topic: str, type_name: str, frame: str, fields: Fields) -> None:
    kind = message(type_name)
    publisher = node.create_publisher(kind, topic, 10)

    def tell() -> None:
        now = node.get_clock().now().to_msg()
        stamp = {"sec": now.sec, "nanosec": now.nanosec}
        publisher.publish(from_dict(kind, headed(type_name, fields, frame, stamp)))

    node.create_timer(_PERIOD_S, tell)
