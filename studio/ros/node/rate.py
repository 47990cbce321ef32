"""Rate: sleeps until the next beat of a timer."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING

from studio.errors import DestroyedError, ExternalShutdownException

if TYPE_CHECKING:
    from studio.ros.node.clock import Clock
    from studio.ros.node.node import Node
    from studio.ros.node.timer import Timer

_PATIENCE_S = 2.0


class Rate:
    """Beats by a timer that whoever spins the node carries out: without spinning it sleeps on.

    A beat that came before `sleep` counts, so that a loop of `spin_once` and `sleep` keeps time.
    """

    def __init__(self, node: Node, frequency_hz: float, clock: Clock | None = None) -> None:
        if frequency_hz <= 0:
            raise ValueError("a rate is above 0 Hz")
        self._node = node
        self._beat = threading.Event()
        self._period_s = 1.0 / frequency_hz
        self._timer: Timer | None = node.create_timer(self._period_s, self._beat.set, clock=clock)
        node.context.on_end(self._beat.set)

    def sleep(self) -> None:
        """Sleep until the next beat.

        Raises:
            DestroyedError: The rate was destroyed.
            ExternalShutdownException: The process was told to end.
        """
        patience_s = 2 * self._period_s + _PATIENCE_S
        while not self._beat.wait(patience_s):
            self._node.get_logger().warning(
                "Nobody spins this node, so that its rate sleeps on: call spin_once in the loop, "
                "or spin in a thread.",
                once=True,
            )
        self._beat.clear()
        if not self._node.context.ok():
            self._beat.set()
            raise ExternalShutdownException
        if self._timer is None:
            self._beat.set()
            raise DestroyedError("rate")

    def destroy(self) -> None:
        """Beat no more; who sleeps is woken."""
        timer, self._timer = self._timer, None
        if timer is not None:
            self._node.destroy_timer(timer)
            self._node.context.forget_end(self._beat.set)
        self._beat.set()
