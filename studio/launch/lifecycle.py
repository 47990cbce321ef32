"""Lifecycle nodes of a launch: their transitions are followed, and asked for."""

from __future__ import annotations

import contextlib
import os
import threading
from typing import TYPE_CHECKING, Any, Final

from studio.errors import StudioError

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

_PATIENCE_S: Final = 30.0


class LifecycleNodes:
    """A node of the launch's own, made when it is needed; its callbacks come on another thread.

    Args:
        environment: The way to the router.
        trouble: Told what went wrong, a sentence.
    """

    def __init__(self, environment: Mapping[str, str], trouble: Callable[[str], None]) -> None:
        self._environment, self._trouble = dict(environment), trouble
        self._lock = threading.Lock()
        self._node: Any = None
        self._context: Any = None
        self._followed: set[str] = set()

    def follow(self, name: str, moved: Callable[[str, str, str], None]) -> None:
        """Call `moved` with transition, start and goal state of each transition of a node."""
        if name in self._followed:
            return
        self._followed.add(name)

        def take(event: Any) -> None:
            moved(event.transition.label, event.start_state.label, event.goal_state.label)

        with self._lock:
            node = self._own()
            kind = node.wire.types.message("lifecycle_msgs/msg/TransitionEvent")
            node.create_subscription(kind, f"{name}/transition_event", take, 10)

    def change(self, name: str, transition: int) -> Callable[[], None]:
        """Return a function that asks a node for a transition, and waits for its answer."""

        def ask() -> None:
            from studio.ros.lifecycle.client import LifecycleClient  # noqa: PLC0415

            try:
                with self._lock:
                    client = LifecycleClient(self._own(), name, _PATIENCE_S)
                with client:
                    if not client.change(transition):
                        self._trouble(f"{name} did not make the transition {transition}")
            except StudioError as error:
                self._trouble(str(error))

        return ask

    def close(self) -> None:
        """Take the node back."""
        with contextlib.suppress(StudioError):
            if self._context is not None:
                self._context.__exit__(None, None, None)

    def _own(self) -> Any:
        if self._node is None:
            import studio.ros.client as rclpy  # noqa: PLC0415

            os.environ.update(self._environment)
            self._context = rclpy.init(
                args=[], signal_handler_options=rclpy.SignalHandlerOptions.NO
            )
            self._context.__enter__()
            self._node = rclpy.create_node(f"launch_ros_{os.getpid()}")
            threading.Thread(target=self._spin, daemon=True).start()
        return self._node

    def _spin(self) -> None:
        import studio.ros.client as rclpy  # noqa: PLC0415

        with contextlib.suppress(Exception):
            rclpy.spin(self._node)
