"""A managed node of somebody else, which also tells how its parts are."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING

from studio.ros.lifecycle import LifecycleNode, LifecycleState, TransitionCallbackReturn
from studio.ros.messages import message
from tests.support.demos import spun
from tests.support.node_pair import context_at

if TYPE_CHECKING:
    from collections.abc import Generator

ARRAY = message("diagnostic_msgs/msg/DiagnosticArray")
STATUS = message("diagnostic_msgs/msg/DiagnosticStatus")
PAIR = message("diagnostic_msgs/msg/KeyValue")
_EVERY_S = 0.2


class Arm(LifecycleNode):
    """Does what it is asked, but does not become active when it is stubborn."""

    stubborn = False

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        if self.stubborn:
            return TransitionCallbackReturn.FAILURE
        return super().on_activate(state)

    def tell_parts(self) -> None:
        """Tell from now on how its motor and its camera are."""
        out = self.create_publisher(ARRAY, "/diagnostics", 10)
        hot = STATUS(
            name="arm: motor",
            level=1,
            message="hot",
            hardware_id="arm-07",
            values=[PAIR(key="temperature", value="81 °C"), PAIR(key="current", value="4.2 A")],
        )
        fine = STATUS(name="arm: camera", message="30 pictures in a second", hardware_id="arm-07")
        self.create_timer(_EVERY_S, lambda: out.publish(ARRAY(status=[hot, fine])))


@contextmanager
def managed_arm(endpoint: str) -> Generator[Arm]:
    """The node, in a session of its own."""
    with context_at(endpoint) as context:
        arm = Arm("arm", context=context)
        with spun(context, arm):
            yield arm
