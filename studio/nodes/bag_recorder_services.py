"""The services of a recorder by which other nodes pause, split and save, as rosbag2 names them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.nodes.bag_recorder import BagRecorder
    from studio.ros.node.node import Node

_PACKAGE = "rosbag2_interfaces/srv"


def serve_recorder(node: Node, recorder: BagRecorder, stop: Callable[[], object]) -> None:
    """Serve them by a node, until it is destroyed; `stop` is called by the one that ends it."""

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


def _serve(node: Node, name: str, kind: str, step: Callable[[Any], object]) -> None:
    def answer(_request: object, response: Any) -> Any:  # noqa: ANN401
        step(response)
        return response

    node.create_service(node.wire.types.service(f"{_PACKAGE}/{kind}"), f"~/{name}", answer)
