# pyright: basic, reportMissingImports=false
"""`python -m tests.support.foreign_process PORT`: zenoh-ros2-sdk, told by lines of JSON what to do.

Each line names a method of `Peer` and its arguments; what it hears and answers are lines too.
It runs in a process of its own because it has one session for each process, for ever.
"""

from __future__ import annotations

import json
import logging
import sys
import threading
from typing import Any

import zenoh_ros2_sdk as sdk

STRING = ("std_msgs/msg/String", "string data")
ADD = ("example_interfaces/srv/AddTwoInts", "int64 a\nint64 b", "int64 sum")
_writing = threading.Lock()


def say(**event: object) -> None:
    """Write an event at once."""
    with _writing:
        sys.stdout.write(json.dumps(event) + "\n")
        sys.stdout.flush()


class Peer:
    """Publishers, subscribers, servers and clients of the other implementation."""

    def __init__(self, port: int) -> None:
        self._at = {"router_ip": "127.0.0.1", "router_port": port, "domain_id": 0}
        self._publishers: dict[str, sdk.ROS2Publisher] = {}
        self._kept: list[object] = []

    def publish(self, topic: str, data: str, qos: str | None = None, node: str = "peer") -> None:
        """Send a text; the publisher is made when it is first needed."""
        if topic not in self._publishers:
            self._publishers[topic] = sdk.ROS2Publisher(
                topic, *STRING, node_name=node, qos=qos, **self._at
            )
        self._publishers[topic].publish(data=data)

    def publish_with_hash(self, topic: str, data: str, type_hash: str) -> None:
        """Send a text under another hash than its type has."""
        self._publishers[topic] = sdk.ROS2Publisher(
            topic, *STRING, type_hash=type_hash, node_name="mistaken", **self._at
        )
        self._publishers[topic].publish(data=data)

    def subscribe(self, topic: str, qos: str | None = None, node: str = "listening_peer") -> None:
        """Say what comes on a topic of texts."""

        def hear(message: Any) -> None:  # noqa: ANN401
            say(heard=message.data, topic=topic)

        self._kept.append(
            sdk.ROS2Subscriber(
                topic, STRING[0], hear, STRING[1], node_name=node, qos=qos, **self._at
            )
        )

    def serve(self, service: str, type_hash: str) -> None:
        """Add two numbers for whoever asks."""
        server: sdk.ROS2ServiceServer

        def add(request: Any) -> Any:  # noqa: ANN401
            return server.response_msg_class(sum=request.a + request.b)

        server = sdk.ROS2ServiceServer(
            service, ADD[0], add, *ADD[1:], node_name="adding_peer", type_hash=type_hash, **self._at
        )
        self._kept.append(server)

    def call(self, service: str, type_hash: str, a: int, b: int) -> None:
        """Have two numbers added."""
        client = sdk.ROS2ServiceClient(
            service, ADD[0], *ADD[1:], node_name="asking_peer", type_hash=type_hash, **self._at
        )
        answer: Any = client.call(a=a, b=b)
        say(answered=None if answer is None else answer.sum)
        client.close()

    def look(self) -> None:
        """Say which topics, publishers and services it sees."""
        where = {"router_ip": self._at["router_ip"], "router_port": self._at["router_port"]}
        topics = sdk.get_topic_names_and_types(domain_id=0, **where)
        services = sdk.get_service_names_and_types(domain_id=0, **where)
        say(topics=dict(topics), services=dict(services))


def main(port: int) -> None:
    """Do what each line says, until there are no more."""
    logging.basicConfig(stream=sys.stderr)
    peer = Peer(port)
    say(ready=True)
    for line in sys.stdin:
        told = json.loads(line)
        try:
            getattr(peer, told.pop("do"))(**told)
            say(done=True)
        except Exception as error:  # noqa: BLE001  # the test is to hear of it
            say(failed=repr(error))
    sdk.ZenohSession.get_instance().close()


if __name__ == "__main__":
    main(int(sys.argv[1]))
