"""A robot of which much is wrong, in a session of its own, and a router that can be killed."""

from __future__ import annotations

import sys
import threading
import time
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from studio.ros.action import ActionServer, GoalResponse
from studio.ros.client import Context, Node, Parameter
from studio.ros.messages import message, shared_types
from studio.ros.node.task import Future
from studio.ros.node.work import ReentrantCallbackGroup
from studio.ros.types.type_descriptions import DESCRIPTION_SERVICE_PARAMETER
from tests.support.demos import node_at, running
from tests.support.goals import FIBONACCI, Held
from tests.support.wire import open_test_session

if TYPE_CHECKING:
    from collections.abc import Generator

    from tests.support.demos import RunningDemo

STRANGE, STRANGE_TEXT = "strange_msgs/msg/Thing", "string data"
NUMBERS = "std_msgs/msg/Float64MultiArray"
RATE_HZ = 30.0
UNWANTED = 13
CUT = b"\x00\x01\x00\x00" + b"\xff" * 12
"""The head of plain CDR, and more numbers than there are bytes."""


class FaultyRobot:
    """Tells its count on `/count` at 30 Hz, what cannot be read on `/cut` and `/strange`.

    It never answers `/silent`, and rejects an order of `fibonacci`.
    """

    def __init__(self, node: Node, stranger: Node) -> None:
        self.count = 0
        self._numbers = message(NUMBERS)
        self._count_out = node.create_publisher(self._numbers, "/count", 10)
        self._cut_out = node.create_publisher(self._numbers, "/cut", 10)
        self._strange = stranger.wire.types.message(STRANGE)
        self._strange_out = stranger.create_publisher(self._strange, "/strange", 10)
        self._cuts = True
        self._speaks = True
        self._ended = threading.Event()
        self._telling = threading.Thread(target=self._tell)
        kind = node.wire.types.service("example_interfaces/srv/AddTwoInts")
        group = ReentrantCallbackGroup()
        node.create_service(kind, "/silent", never_answered, callback_group=group)
        self._server = ActionServer(
            node, node.wire.types.action(FIBONACCI), "fibonacci", Held(), goal_callback=_take
        )

    @contextmanager
    def telling(self) -> Generator[None]:
        """Publish for as long as the block."""
        self._telling.start()
        try:
            yield
        finally:
            self._ended.set()
            self._telling.join()

    def fall_silent(self) -> None:
        """Publish nothing any more."""
        self._speaks = False

    def speak_again(self) -> None:
        """Publish on."""
        self._speaks = True

    def send_whole(self) -> None:
        """What is published on `/cut` can be read from now on."""
        self._cuts = False

    def _tell(self) -> None:
        """Keep the rate also where the machine is busy: what is late is made up for."""
        due_s = time.monotonic()
        while not self._ended.wait(max(0.0, due_s - time.monotonic())):
            due_s += 1 / RATE_HZ
            if self._speaks:
                self._beat()

    def _beat(self) -> None:
        self.count += 1
        numbers = self._numbers(data=[float(self.count)])
        self._count_out.publish(numbers)
        self._cut_out.publish(CUT if self._cuts else numbers)
        self._strange_out.publish(self._strange(data="odd"))


async def never_answered(_request: Any, response: Any) -> Any:  # noqa: ANN401
    """A service's callback that waits for ever; its group lets others be carried out."""
    await Future[Any](executor=None)
    return response


def _take(goal: Any) -> GoalResponse:  # noqa: ANN401 - of the action's own class
    return GoalResponse.REJECT if goal.order == UNWANTED else GoalResponse.ACCEPT


@contextmanager
def faulty_robot(endpoint: str) -> Generator[FaultyRobot]:
    """Two nodes, of which one has a type that nobody else knows and that it does not tell."""
    types = shared_types().copy()
    types.add_texts({STRANGE: STRANGE_TEXT})
    with (
        node_at(endpoint, "robot") as node,
        open_test_session(endpoint, types=types) as session,
    ):
        context = Context.over(session)
        tells_nothing = Parameter(DESCRIPTION_SERVICE_PARAMETER, value=False)
        stranger = Node("stranger", context=context, parameter_overrides=[tells_nothing])
        robot = FaultyRobot(node, stranger)
        with robot.telling():
            yield robot
        context.shutdown()


@contextmanager
def router_process(endpoint: str) -> Generator[RunningDemo]:
    """A router that can be killed, for as long as the block."""
    with running([sys.executable, "-m", "studio", "router", "--listen", endpoint], endpoint) as it:
        it.wait_for("Ctrl-C")
        yield it
