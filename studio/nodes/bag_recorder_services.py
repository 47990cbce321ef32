"""What other nodes see of a recorder, named as rosbag2 names it: its services, and its splits."""

from __future__ import annotations

import contextlib
from typing import TYPE_CHECKING, Any, Final

from studio.errors import DestroyedError

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from studio.nodes.bag_recorder import BagRecorder
    from studio.ros.node.node import Node

_PACKAGE = "rosbag2_interfaces/srv"
_SPLITS: Final = "events/write_split"


def serve_recorder(node: Node, recorder: BagRecorder, stop: Callable[[], object]) -> None:
    """Offer them by a node, until it is destroyed; `stop` is called by the service that ends it."""

    def is_paused(response: Any) -> None:  # noqa: ANN401 - made of the type of the service
        response.paused = recorder.is_paused

    def is_running(response: Any) -> None:  # noqa: ANN401
        response.running = recorder.is_discovering

    def snapshot(response: Any) -> None:  # noqa: ANN401
        response.success = recorder.snapshot()

    steps: dict[tuple[str, str], Callable[[Any], object]] = {
        ("snapshot", "Snapshot"): snapshot,
        ("pause", "Pause"): lambda _: recorder.pause(),
        ("resume", "Resume"): lambda _: recorder.resume(),
        ("is_paused", "IsPaused"): is_paused,
        ("split_bagfile", "SplitBagfile"): lambda _: recorder.split(),
        ("start_discovery", "StartDiscovery"): lambda _: recorder.discover(wanted=True),
        ("stop_discovery", "StopDiscovery"): lambda _: recorder.discover(wanted=False),
        ("is_discovery_running", "IsDiscoveryRunning"): is_running,
        ("stop", "Stop"): lambda _: stop(),
    }
    for (name, kind), step in steps.items():
        _serve(node, name, kind, step)
    recorder.on_split = _teller(node)


def _teller(node: Node) -> Callable[[Path, Path], None]:
    """Return what publishes that another file begins."""
    kind = node.wire.types.message("rosbag2_interfaces/msg/WriteSplitEvent")
    publisher = node.create_publisher(kind, _SPLITS, 1)

    def tell(closed: Path, opened: Path) -> None:  # in the thread that writes
        event = kind(closed_file=str(closed), opened_file=str(opened))
        if hasattr(event, "node_name"):  # since Jazzy
            event.node_name = node.get_fully_qualified_name()
        with contextlib.suppress(DestroyedError):  # the node ends, and the bag after it
            publisher.publish(event)

    return tell


def _serve(node: Node, name: str, kind: str, step: Callable[[Any], object]) -> None:
    def answer(_request: object, response: Any) -> Any:  # noqa: ANN401
        step(response)
        return response

    node.create_service(node.wire.types.service(f"{_PACKAGE}/{kind}"), f"~/{name}", answer)
