"""A ROS 2 system to be examined: nodes at a real router, and the Doctor's own session there."""

from __future__ import annotations

import time
from contextlib import ExitStack, contextmanager, nullcontext
from typing import TYPE_CHECKING, Any

from studio.live.doctor.asking import ask, look
from studio.live.doctor.examination import examine
from studio.live.doctor.seen import Seen
from studio.live.doctor.watching import Watching
from studio.ros.graph.diagnosis import DistroHashes
from studio.ros.messages import message
from studio.ros.node.context import Context
from studio.ros.tokens import EndpointKind
from tests.support.demos import node_at
from tests.support.wire import open_test_session, running_router, wait_until

if TYPE_CHECKING:
    from collections.abc import Callable, Generator

    from studio.live.doctor.examination import Examination
    from studio.protocol.doctor import Finding
    from studio.ros.client import Node, Publisher, QoSProfile
    from studio.ros.wire.session import WireSession

STRING, SCAN = "std_msgs/msg/String", "sensor_msgs/msg/LaserScan"
TF, CLOCK = "tf2_msgs/msg/TFMessage", "rosgraph_msgs/msg/Clock"


class Patient:
    """One router, one node of the robot, and what a Doctor sees of them; shared by many tests.

    What a test adds is taken away after it. `later_s` moves the Doctor's clock on.
    """

    def __init__(self, endpoint: str, wire: WireSession, robot: Node) -> None:
        self.endpoint, self.robot, self._wire = endpoint, robot, wire
        self.later_s = 0.0
        self.context = Context.over(wire)
        self.watching = self._new_watching()
        self._hashes = DistroHashes(wire.types)
        self._added = ExitStack()

    def publisher(
        self, type_name: str, topic: str, qos: QoSProfile | int = 10, node: Node | None = None
    ) -> Publisher:
        """Publish, on the robot unless another node is given."""
        node = node or self.robot
        with self._shown(EndpointKind.PUBLISHER, topic):
            made = node.create_publisher(message(type_name), topic, qos)
        if node is self.robot:
            self._added.callback(node.destroy_publisher, made)
        return made

    def subscribe(self, type_name: str, topic: str, qos: QoSProfile | int = 10) -> None:
        """Have the robot subscribe to a topic."""
        with self._shown(EndpointKind.SUBSCRIPTION, topic):
            made = self.robot.create_subscription(message(type_name), topic, _ignore, qos)
        self._added.callback(self.robot.destroy_subscription, made)

    def node(self, name: str) -> Node:
        """Another node, in a process of its own as far as others see."""
        return self._added.enter_context(node_at(self.endpoint, name))

    def after(self, callback: Callable[[], object]) -> None:
        """Take something else away after the test."""
        self._added.callback(callback)

    def seen(self, *, asks: bool = False) -> Seen:
        """What the Doctor sees now."""
        own = frozenset({self._wire.zid})
        system = look(self._wire, self.context.graph, self._wire.types, self._hashes, own=own)
        answers = ask(self._wire, system) if asks else None
        return Seen(system=system, heard=self.watching.heard(system), answers=answers)

    def examined(self, *, asks: bool = False) -> Examination:
        """What it concludes."""
        return examine(self.seen(asks=asks))

    def listened_to(self) -> set[str]:
        """Topics that the Doctor listens to now."""
        heard = self.seen().heard
        return set(heard.topics) if heard else set()

    def codes(self, about: str, *, asks: bool = False) -> set[str]:
        """Codes of all findings whose sentence has a name in it."""
        found = self.examined(asks=asks).findings
        return {one.code for one in found if about in one.sentence}

    def until(
        self,
        code: str,
        about: str = "",
        *,
        asks: bool = False,
        do: Callable[[], object] = lambda: None,
    ) -> Finding:
        """Wait for a finding of a code whose sentence has a name in it; `do` is done meanwhile."""
        found: list[Finding] = []

        def is_found() -> bool:
            do()
            all_of_them = self.examined(asks=asks).findings
            found[:] = [one for one in all_of_them if one.code == code and about in one.sentence]
            return bool(found)

        wait_until(f"{code} about {about}", is_found)
        return found[0]

    def heal(self) -> None:
        """Take away what was added, and forget what was heard."""
        self._added.close()
        self.watching.close()
        self.later_s = 0.0
        self.watching = self._new_watching()

    def close(self) -> None:
        """End it."""
        self.heal()
        self.watching.close()
        self.context.shutdown()

    @contextmanager
    def _shown(self, kind: EndpointKind, topic: str) -> Generator[None]:
        """At the end of the block, the Doctor's graph has a new endpoint."""
        graph = self.context.graph

        def tokens() -> set[str]:
            return {one.token for one in graph.all_of(kind).get(topic, ())}

        before = tokens()
        yield
        wait_until(f"{topic} is shown", lambda: bool(tokens() - before))

    def _new_watching(self) -> Watching:
        return Watching(self.context, self._wire.types, lambda: time.monotonic() + self.later_s)


@contextmanager
def patient_system(at: str = "") -> Generator[Patient]:
    """A patient at a router, or at one of its own, until the block ends."""
    with (
        nullcontext(at) if at else running_router() as endpoint,
        open_test_session(endpoint) as wire,
        node_at(endpoint, "robot") as robot,
    ):
        made = Patient(endpoint, wire, robot)
        try:
            yield made
        finally:
            made.close()


def stamped(type_name: str, frame: str, stamp_ns: int) -> Any:  # noqa: ANN401
    """A message with a header."""
    made: Any = message(type_name)()
    made.header.frame_id = frame
    made.header.stamp.sec, made.header.stamp.nanosec = divmod(stamp_ns, 10**9)
    return made


def transform(parent: str, child: str, stamp_ns: int) -> Any:  # noqa: ANN401
    """A message of /tf with one transform."""
    one = stamped("geometry_msgs/msg/TransformStamped", parent, stamp_ns)
    one.child_frame_id = child
    one.transform.rotation.w = 1.0
    return message(TF)(transforms=[one])


def clock_at(now_ns: int) -> Any:  # noqa: ANN401
    """A message of /clock."""
    made: Any = message(CLOCK)()
    made.clock.sec, made.clock.nanosec = divmod(now_ns, 10**9)
    return made


def _ignore(_message: object) -> None:
    """Take a message and do nothing."""
