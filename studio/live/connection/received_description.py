"""A robot's description from a topic or a parameter, kept until it is taken."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING, Final, NamedTuple, Protocol

from studio.live.topics.request import Request
from studio.live.topics.source import decoder

if TYPE_CHECKING:
    from studio.live.topics.source import TopicSource
    from studio.protocol.connection import OpenFromWire
    from studio.ros.node.samples import RawSample

STRING: Final = "std_msgs/msg/String"
_EVENT: Final = "rcl_interfaces/msg/ParameterEvent"
_EVENTS: Final = Request("/parameter_events", (_EVENT,), depth=1_000, as_known_here=True)


class ReadsParameters(Protocol):
    """The part of a connection that reads parameters."""

    def parameter(self, node: str, name: str) -> str:
        """Return the value of a parameter that is a text; waits, and raises a StudioError."""
        ...


class ParameterPlace(NamedTuple):
    """A parameter of a node."""

    node: str
    name: str


class ReceivedDescription:
    """Receives the description of a robot; the newest is kept until it is taken.

    Args:
        source: Where topics come from.
        topic: That has it; not read where a parameter has it.
        parameter: That has it; its changes are received.
        first: The value of the parameter now.
    """

    def __init__(
        self,
        source: TopicSource,
        topic: str,
        parameter: ParameterPlace | None = None,
        first: str = "",
    ) -> None:
        self.source = f"{parameter.node} {parameter.name}" if parameter else topic
        self._parameter = parameter
        self._came = threading.Condition()
        self._newest: str | None = first or None
        self._decode = decoder(source, _EVENT if parameter else STRING)
        self.close = (
            source.subscribe(_EVENTS, take=self._take_event)
            if parameter
            else source.subscribe(_description(topic), take=self._take)
        ).close

    def first(self, timeout_s: float) -> str | None:
        """Wait for a text; None when none came."""
        with self._came:
            self._came.wait_for(lambda: self._newest is not None, timeout_s)
        return self.newest()

    def newest(self) -> str | None:
        """Return what came since the last call; None: nothing."""
        with self._came:
            taken, self._newest = self._newest, None
        return taken

    def _take(self, sample: RawSample) -> None:
        self._keep(self._decode(sample).data)

    def _take_event(self, sample: RawSample) -> None:
        event = self._decode(sample)
        if self._parameter is None or event.node != self._parameter.node:
            return
        for one in (*event.new_parameters, *event.changed_parameters):
            if one.name == self._parameter.name:
                self._keep(one.value.string_value)

    def _keep(self, text: str) -> None:
        with self._came:
            self._newest = text
            self._came.notify_all()


def receive_description(
    source: TopicSource, connection: ReadsParameters, wanted: OpenFromWire
) -> ReceivedDescription:
    """Begin to receive a robot's description; in a thread, for a parameter is waited for.

    Raises:
        NotServedError: There is no such node, or it has no parameters.
        NoAnswerError: It does not answer.
    """
    if not wanted.node:
        return ReceivedDescription(source, wanted.topic)
    value = connection.parameter(wanted.node, wanted.parameter)
    place = ParameterPlace(wanted.node, wanted.parameter)
    return ReceivedDescription(source, "", place, value)


def _description(topic: str) -> Request:
    return Request(
        topic, (STRING,), newest_only=True, depth=1, usually=(True, True), as_known_here=True
    )
