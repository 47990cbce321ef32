"""`python -m tests.support.dds_robot`: a robot on DDS that does what lines of JSON ask for.

Each line names a method of `Robot` and its arguments: `{"do": "publish", "id": 3, "topic": ...}`.
It says a line for each that is done, `{"what": "done", "id": 3, "answer": ...}`, and for all that
it hears. It runs in a process of its own: Cyclone DDS reads its settings once.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import logging
import signal
import socket
import sys
import threading
from typing import TYPE_CHECKING, Any, Final

from studio.errors import StudioError
from studio.ros.cdr import codec_of
from studio.ros.lifecycle.machine import LifecycleMachine, StateId, TransitionCallbackReturn
from studio.ros.lifecycle.node import LifecycleServices
from studio.ros.names import full_type_name
from studio.ros.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from studio.ros.types.convert import from_dict, to_dict
from tests.support.dds_actions import FibonacciServer, GoalSender
from tests.support.dds_classroom import ClassroomRobot
from tests.support.dds_node import DdsProcess

if TYPE_CHECKING:
    from collections.abc import Mapping
    from types import FrameType

    from studio.ros.lifecycle.machine import Transition
    from studio.ros.types.classes import MessageValue
    from tests.support.dds_node import (
        DdsClient,
        DdsNode,
        DdsPublisher,
        DdsService,
        DdsSubscription,
        Timer,
    )

_SHOWN_BYTES_MAX: Final = 65_536
"""Of what is longer, length and digest are told."""


def say(what: str, **values: object) -> None:
    """Write a line."""
    sys.stdout.write(json.dumps({"what": what, **values}) + "\n")
    sys.stdout.flush()


def qos_of(given: Mapping[str, Any] | None) -> QoSProfile:
    """A profile of `reliability`, `durability`, `history` and `depth`, by ROS's words."""
    words: dict[str, Any] = {"depth": 10, **(given or {})}
    return QoSProfile(
        reliability=ReliabilityPolicy[words.get("reliability", "reliable").upper()],
        durability=DurabilityPolicy[words.get("durability", "volatile").upper()],
        history=HistoryPolicy[words.get("history", "keep_last").upper()],
        depth=int(words["depth"]),
    )


def _add(request: MessageValue, response: MessageValue) -> MessageValue:
    response.sum = request.a + request.b
    return response


def _agree(request: MessageValue, response: MessageValue) -> MessageValue:
    response.success = True
    response.message = str(getattr(request, "data", "triggered"))
    return response


def _refuse(request: MessageValue, response: MessageValue) -> MessageValue:
    del request
    response.success, response.message = False, "refused"
    return response


def _answer(request: MessageValue, response: MessageValue) -> MessageValue:
    del request
    return response


def _be_silent(request: MessageValue, response: MessageValue) -> None:
    del request, response


def _succeed(_callback: str, _before: StateId) -> TransitionCallbackReturn:
    return TransitionCallbackReturn.SUCCESS


BEHAVIOURS: Final[dict[str, Any]] = {
    "add": _add,
    "agree": _agree,
    "refuse": _refuse,
    "default": _answer,
    "silent": _be_silent,
}
"""Of a service: AddTwoInts, Trigger and SetBool, the response's defaults, and no answer at all."""


class Robot:
    """What a test can ask for; nodes are named from /, and made when they are first named."""

    def __init__(self, process: DdsProcess) -> None:
        self._process, self._types = process, process.types
        self._nodes: dict[str, DdsNode] = {}
        self._publishers: dict[tuple[str, str], DdsPublisher] = {}
        self._subscriptions: dict[tuple[str, str], DdsSubscription] = {}
        self._services: dict[tuple[str, str], DdsService] = {}
        self._clients: dict[tuple[str, str], DdsClient] = {}
        self._timers: dict[str, Timer] = {}
        self._actions: dict[str, FibonacciServer] = {}
        self._senders: dict[str, GoalSender] = {}
        self._classroom: ClassroomRobot | None = None

    def node(self, node: str) -> None:
        """Have a node, `/arm/driver`."""
        self._node(node)

    def remove_node(self, node: str) -> None:
        """Take a node away with all that it has."""
        self._nodes.pop(node).destroy_node()
        for ends in (self._publishers, self._subscriptions, self._services, self._clients):
            for key in [one for one in ends if one[0] == node]:
                del ends[key]

    def advertise(
        self, topic: str, type_name: str, qos: dict[str, Any] | None = None, node: str = "/robot"
    ) -> None:
        """Have a publisher."""
        self._publisher(node, topic, type_name, qos)

    def publish(  # noqa: PLR0913
        self,
        topic: str,
        type_name: str,
        values: dict[str, Any] | None = None,
        *,
        qos: dict[str, Any] | None = None,
        node: str = "/robot",
        rate_hz: float = 0.0,
        count: int = 1,
        filled: dict[str, int] | None = None,
    ) -> None:
        """Send a message, `count` times at once, or at a rate until `stop`.

        `filled` names sequences of bytes and how long each is to be.
        """
        publisher = self._publisher(node, topic, type_name, qos)
        kind = self._types.message(full_type_name(type_name, "msg"))
        whole = {**(values or {}), **{name: bytes(size) for name, size in (filled or {}).items()}}
        cdr = bytes(codec_of(kind).encode(from_dict(kind, whole)))
        if rate_hz:
            self.stop(topic)
            self._timers[topic] = self._process.every(
                1.0 / rate_hz, lambda: publisher.publish_cdr(cdr)
            )
            return
        for _ in range(count):
            publisher.publish_cdr(cdr)

    def matched(self, topic: str, node: str = "/robot") -> int:
        """How many readers a publisher has now, or how many writers a subscription has."""
        publisher = self._publishers.get((node, topic))
        if publisher is not None:
            return publisher.writers[0].matched
        return self._subscriptions[node, topic].readers[0].matched

    def stop(self, topic: str) -> None:
        """Send no more at a rate."""
        if topic in self._timers:
            self._timers.pop(topic).cancel()

    def unadvertise(self, topic: str, node: str = "/robot") -> None:
        """Take a publisher away."""
        self.stop(topic)
        self._node(node).destroy(self._publishers.pop((node, topic)))

    def subscribe(
        self, topic: str, type_name: str, qos: dict[str, Any] | None = None, node: str = "/robot"
    ) -> None:
        """Say `heard` for what comes on a topic."""
        kind = self._types.message(full_type_name(type_name, "msg"))

        def hear(cdr: bytes) -> None:
            told: dict[str, object] = {"topic": topic, "node": node, "bytes": len(cdr)}
            if len(cdr) <= _SHOWN_BYTES_MAX:
                told["message"] = to_dict(codec_of(kind).decode(cdr))
            say("heard", **told, sha256=hashlib.sha256(cdr).hexdigest())

        made = self._node(node).create_subscription(kind, topic, hear, qos_of(qos))
        self._subscriptions[node, topic] = made

    def unsubscribe(self, topic: str, node: str = "/robot") -> None:
        """Hear a topic no more."""
        self._node(node).destroy(self._subscriptions.pop((node, topic)))

    def serve(self, service: str, type_name: str, behaviour: str, node: str = "/robot") -> None:
        """Serve, and say `asked` for each request."""
        kind = self._types.service(full_type_name(type_name, "srv"))

        def handle(request: MessageValue, response: MessageValue) -> MessageValue | None:
            say("asked", service=service, request=to_dict(request))
            return BEHAVIOURS[behaviour](request, response)

        self._services[node, service] = self._node(node).create_service(kind, service, handle)

    def call(
        self,
        service: str,
        type_name: str,
        values: dict[str, Any] | None = None,
        node: str = "/robot",
    ) -> None:
        """Call a service once it is there, and say `answered`."""
        kind = self._types.service(full_type_name(type_name, "srv"))
        client = self._clients.get((node, service))
        if client is None:
            client = self._clients[node, service] = self._node(node).create_client(kind, service)

        def hear(response: MessageValue) -> None:
            say("answered", service=service, response=to_dict(response))

        client.call(from_dict(kind.Request, values or {}), hear)

    def unserve(self, service: str, node: str = "/robot") -> None:
        """Take a server away."""
        self._node(node).destroy(self._services.pop((node, service)))

    def remove_client(self, service: str, node: str = "/robot") -> None:
        """Take a client away."""
        self._node(node).destroy(self._clients.pop((node, service)))

    def parameters(self, values: dict[str, Any], node: str = "/robot") -> None:
        """Give a node parameters, which others may read and set."""
        made = self._node(node)
        made.open_parameters(made, self._types)
        for name, value in values.items():
            made.declare_parameter(name, value)

    def parameter(self, name: str, node: str = "/robot") -> object:
        """The value that a parameter has now."""
        return self._node(node).get_parameter(name).value

    def manage(self, node: str = "/robot") -> None:
        """Give a node states and transitions, all of which succeed; say `state`."""
        services: LifecycleServices

        def tell(transition: Transition) -> None:
            services.publish_transition(transition)

        machine = LifecycleMachine(_succeed, tell)

        def trigger(wanted: int | str) -> TransitionCallbackReturn:
            result = machine.trigger(wanted)
            say("state", node=node, state=machine.state.label)
            return result

        made: Any = self._node(node)
        services = LifecycleServices(made, machine, trigger)

    def serve_fibonacci(self, action: str = "/fibonacci", node: str = "/robot") -> None:
        """Serve the action Fibonacci of example_interfaces, a number each 50 ms."""
        self._actions[action] = FibonacciServer(self._node(node), action, say)

    def send_goal(
        self,
        action: str,
        type_name: str = "example_interfaces/action/Fibonacci",
        goal: dict[str, Any] | None = None,
        node: str = "/robot",
    ) -> str:
        """Send a goal; say `goal_response`, `feedback`, `goal_status` and `result`. Its id."""
        if action not in self._senders:
            self._senders[action] = GoalSender(self._node(node), action, type_name, say)
        return self._senders[action].send(goal or {})

    def cancel_goal(self, action: str, goal_id: str) -> None:
        """Ask that a goal ends; say `cancel_response`."""
        self._senders[action].cancel(goal_id)

    def classroom(self) -> None:
        """Be the robot of a classroom: a body that drives as /cmd_vel says."""
        self._classroom = ClassroomRobot(self._process, say)

    def graph(self) -> list[Any]:
        """Nodes with how many readers and writers each has."""
        entries = [one.entry() for one in self._process.nodes]
        return [[space, name, len(reads), len(writes)] for space, name, reads, writes in entries]

    def _node(self, name: str) -> DdsNode:
        if name not in self._nodes:
            namespace, _, base = name.rpartition("/")
            self._nodes[name] = self._process.node(base, namespace or "/")
        return self._nodes[name]

    def _publisher(
        self, node: str, topic: str, type_name: str, qos: dict[str, Any] | None
    ) -> DdsPublisher:
        made = self._publishers.get((node, topic))
        if made is None:
            kind = self._types.message(full_type_name(type_name, "msg"))
            made = self._node(node).create_publisher(kind, topic, qos_of(qos))
            self._publishers[node, topic] = made
        return made


def _do(robot: Robot, told: dict[str, Any]) -> None:
    number = told.pop("id")
    try:
        answer = getattr(robot, told.pop("do"))(**told)
    except (StudioError, LookupError, TypeError, ValueError, AttributeError) as error:
        say("done", id=number, error=repr(error))
    else:
        say("done", id=number, answer=answer)


def _read(process: DdsProcess, robot: Robot) -> None:
    for line in sys.stdin:
        told = json.loads(line)
        process.ask(lambda told=told: _do(robot, told))
    process.end()


def _wait(_number: int, _frame: FrameType | None) -> None:
    """What a signal does to this thread: nothing."""


def _end_by_signal(process: DdsProcess) -> None:
    """The handler itself would wait for this thread, which waits within Cyclone."""
    come, goes = socket.socketpair()
    goes.setblocking(False)
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, _wait)
    signal.set_wakeup_fd(goes.detach())

    def end() -> None:
        come.recv(1)
        process.end()

    threading.Thread(target=end, daemon=True).start()


def main() -> None:
    """Do what each line says, until there are no more or SIGTERM comes."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--distro", default="jazzy", help="humble, jazzy, kilted or rolling")
    parser.add_argument("--domain", type=int, default=0)
    parser.add_argument("--robot", choices=["classroom"], help="be this one at once")
    chosen = parser.parse_args()
    logging.basicConfig(stream=sys.stderr)
    process = DdsProcess(chosen.distro, chosen.domain)
    robot = Robot(process)

    if chosen.robot == "classroom":
        robot.classroom()
    threading.Thread(target=_read, args=(process, robot), daemon=True).start()
    _end_by_signal(process)
    say("ready", participant=process.participant.guid.hex())
    process.run()


if __name__ == "__main__":
    main()
