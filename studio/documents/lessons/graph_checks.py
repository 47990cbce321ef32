"""Checks of the graph: the nodes, topics and services of one ROS system, and their answers.

It imports Zenoh (through `ros`), so it is imported when the first one is looked at.
"""

from __future__ import annotations

import asyncio
import json
import math
import time
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final, NamedTuple, TypeAlias, cast

from studio.documents.lessons.frames import Frames
from studio.documents.lessons.verdict import HOLDS, Verdict, is_same, missing
from studio.errors import StudioError
from studio.live.panels.requests import ServiceRequest
from studio.ros.types.yaml_texts import read_yaml

if TYPE_CHECKING:
    from collections.abc import Callable, Container, Iterable, Mapping

    from studio.course.lessons.checks import Check
    from studio.live.connection.link import WireLink
    from studio.ros.graph.endpoints import GraphEndpoint
    from studio.ros.node.topic_statistics import TopicStatistics

_Values: TypeAlias = "Mapping[str, str]"
_KEPT_S: Final = 10.0
"""What nobody asks for is not received any longer."""
_STEADY_S: Final = 2.0
_STEADY_PERIODS: Final = 4
"""So long, and for so many periods, a rate must be right: it passes through others as it begins."""
_OVERDUE_S: Final = 1.0
_OVERDUE_PERIODS: Final = 2
_ASKED_KINDS: Final = frozenset({"answers", "parameter"})
"""Of checks that a node has to answer."""
_AGAIN_S: Final = 3.0
"""Between two questions to a node that gave another answer than wanted, or none."""
_AGAIN_WHEN_OK_S: Final = 20.0
_CALL_S: Final = 3.0
_SHOWN: Final = 200
_VALUE_FIELDS: Final = (
    *("", "bool_value", "integer_value", "double_value", "string_value", "byte_array_value"),
    *("bool_array_value", "integer_array_value", "double_array_value", "string_array_value"),
)
"""By the `type` of a rcl_interfaces/msg/ParameterValue."""


@dataclass(slots=True)
class _Asked:
    """A question to a node, and its last answer."""

    verdict: Verdict = field(default_factory=lambda: missing("answer.waiting"))
    at_s: float = -math.inf
    servers: frozenset[str] = frozenset()
    """Tokens of those who were there to answer: others may answer otherwise."""
    task: asyncio.Task[None] | None = None


class _Looked(NamedTuple):
    """What one look at the graph found."""

    verdicts: dict[str, Verdict]
    servers: dict[str, frozenset[str]]
    """Tokens of those who could answer a check, by its line."""


class _Request(NamedTuple):
    name: str
    service_type: str
    text: str


class GraphChecks:
    """Looks at the graph of one connection, and asks its nodes; used on the event loop only."""

    def __init__(self, link: WireLink) -> None:
        self._link = link
        self._rates: dict[str, TopicStatistics] = {}
        self._steady_s: dict[tuple[str, ...], float] = {}
        """Since when a rate has been right."""
        self._frames: Frames | None = None
        self._asked: dict[str, _Asked] = {}

    async def verdicts(
        self, checks: Iterable[Check], *, may_call: Container[str]
    ) -> dict[str, Verdict]:
        """Return how checks stand, by their lines.

        Args:
            checks: Of the graph.
            may_call: Lines of checks for which a service may be called; parameters are only read.
        """
        wanted = {one.line: one for one in checks}
        found, servers = await asyncio.to_thread(self._look, wanted.values())
        for line, there in servers.items():
            check = wanted[line]
            may_ask = check.kind == "parameter" or line in may_call
            if asked := self._compared(line, there, may_ask=may_ask):
                if may_ask:
                    self._ask_again(check, asked)
                found[line] = asked.verdict
            else:
                found[line] = missing("control.none")
        return found

    async def close(self) -> None:
        """Ask and measure no more."""
        tasks = [one.task for one in self._asked.values() if one.task is not None]
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)
        await asyncio.to_thread(self._end)

    def _end(self) -> None:
        for one in self._rates.values():
            one.close()
        if self._frames is not None:
            self._frames.close()

    # What the graph has

    def _look(self, checks: Iterable[Check]) -> _Looked:
        """Look at all but the answers of nodes; in another thread, for graphs may be large."""
        looked = _Looked({}, {})
        is_connected = self._link.is_connected
        for one in checks:
            if not is_connected:
                looked.verdicts[one.line] = missing("ros.lost")
                continue
            try:
                if one.kind in _ASKED_KINDS:
                    ends = self._link.graph.servers(_service_of(one))
                    looked.servers[one.line] = frozenset(end.token for end in ends)
                else:
                    looked.verdicts[one.line] = _FORMS[one.kind](self, one.values)
            except StudioError as error:
                looked.verdicts[one.line] = missing("answer.failed", reason=error)
        if self._frames is not None and time.monotonic() - self._frames.asked_s > _KEPT_S:
            self._frames.close()
            self._frames = None
        return looked

    def node(self, values: _Values) -> Verdict:
        """`node /NAME runs`."""
        there = values["name"] in self._link.node_names()
        return HOLDS if there else missing("node.none")

    def topic_type(self, values: _Values) -> Verdict:
        """`topic /NAME is of TYPE`."""
        return self._typed(values, dict(self._link.graph.topics()), "topic")

    def service_type(self, values: _Values) -> Verdict:
        """`service /NAME is of TYPE`."""
        return self._typed(values, dict(self._link.graph.services()), "service")

    def action_type(self, values: _Values) -> Verdict:
        """`action /NAME is of TYPE`."""
        return self._typed(values, dict(self._link.graph.actions()), "action")

    def _typed(self, values: _Values, there: Mapping[str, list[str]], what: str) -> Verdict:
        types = there.get(values["name"], [])
        if values["type"] in types:
            return HOLDS
        return missing("type.other", type=", ".join(types)) if types else missing(f"{what}.none")

    def servers(self, values: _Values) -> Verdict:
        """`service /NAME has COUNT server(s)`."""
        return self._counted(values, self._others(self._link.graph.servers(values["name"])))

    def publishers(self, values: _Values) -> Verdict:
        """`topic /NAME has COUNT publisher(s)`."""
        return self._counted(values, self._publishers(values["name"]))

    def subscriptions(self, values: _Values) -> Verdict:
        """`topic /NAME has COUNT subscription(s)`."""
        return self._counted(values, self._subscriptions(values["name"]))

    def _counted(self, values: _Values, ends: list[GraphEndpoint]) -> Verdict:
        wanted = int(values["count"])
        return HOLDS if len(ends) == wanted else missing("count.other", count=len(ends))

    def published(self, values: _Values) -> Verdict:
        """`topic /NAME is published RELIABILITY [DURABILITY]`."""
        return _with_qos(values, self._publishers(values["name"]), "publishers.none")

    def subscribed(self, values: _Values) -> Verdict:
        """`topic /NAME is subscribed RELIABILITY [DURABILITY]`."""
        return _with_qos(values, self._subscriptions(values["name"]), "subscriptions.none")

    def _publishers(self, topic: str) -> list[GraphEndpoint]:
        return self._others(self._link.graph.publishers(topic))

    def _subscriptions(self, topic: str) -> list[GraphEndpoint]:
        return self._others(self._link.graph.subscriptions(topic))

    def _others(self, ends: list[GraphEndpoint]) -> list[GraphEndpoint]:
        """Return the ends that are not the studio's."""
        return [one for one in ends if one.node.zid != self._link.zid]

    def rate(self, values: _Values) -> Verdict:
        """`topic /NAME comes at RATE Hz [± PERCENT %]`."""
        topic, wanted_hz = values["name"], float(values["rate"])
        if not self._publishers(topic):
            return missing("publishers.none")
        measured = self._rates.get(topic)
        if measured is None or not measured.is_open:
            measured = self._rates[topic] = self._link.measure(topic, _KEPT_S)
        flow, now_s = measured.flow(), time.monotonic()
        key = topic, values["rate"], values["percent"]
        near_hz = wanted_hz * float(values["percent"]) / 100
        is_near = flow.rate_hz > 0 and abs(flow.rate_hz - wanted_hz) <= near_hz
        is_due = flow.age_s is not None and (
            flow.age_s <= max(_OVERDUE_S, _OVERDUE_PERIODS / wanted_hz)
        )
        if is_near and is_due:
            steady_s = now_s - self._steady_s.setdefault(key, now_s)
            is_long = steady_s >= max(_STEADY_S, _STEADY_PERIODS / wanted_hz)
            return HOLDS if is_long else missing("rate.waiting")
        self._steady_s.pop(key, None)
        if flow.is_silent:
            return missing("rate.silent")
        if is_near or not flow.rate_hz:
            return missing("rate.waiting")
        return missing("rate.other", rate=f"{flow.rate_hz:.2f}")

    def tf(self, values: _Values) -> Verdict:
        """`tf leads from PARENT to CHILD`."""
        if self._frames is None:
            self._frames = Frames(self._link)
        has_static = bool(self._link.graph.publishers("/tf_static"))
        ends = values["parent"], values["child"]
        roots = [self._frames.root_of(one, has_static=has_static) for one in ends]
        for frame, root in zip(ends, roots, strict=True):
            if root is None:
                return missing("tf.unknown", frame=frame)
        return HOLDS if roots[0] == roots[1] else missing("tf.unconnected")

    # What nodes answer

    def _compared(self, line: str, servers: frozenset[str], *, may_ask: bool) -> _Asked | None:
        """Return what was asked for a check, as far as it is about those who can answer now."""
        asked = self._asked.get(line)
        if asked is None:
            if may_ask:
                asked = self._asked[line] = _Asked(servers=servers)
        elif servers != asked.servers:
            asked.servers, asked.at_s = servers, -math.inf
            if asked.verdict.ok:
                asked.verdict = missing("answer.waiting")
        return asked

    def _ask_again(self, check: Check, asked: _Asked) -> None:
        rest_s = _AGAIN_WHEN_OK_S if asked.verdict.ok else _AGAIN_S
        if asked.task is None and time.monotonic() - asked.at_s >= rest_s:
            asked.task = asyncio.create_task(self._ask(check, asked))

    async def _ask(self, check: Check, asked: _Asked) -> None:
        try:
            answer = self._answer if check.kind == "answers" else self._parameter
            servers, verdict = asked.servers, await answer(check.values)
            if servers == asked.servers:
                asked.verdict = verdict
        except StudioError as error:
            asked.verdict = missing("answer.failed", reason=error)
        finally:
            asked.at_s, asked.task = time.monotonic(), None

    async def _answer(self, values: _Values) -> Verdict:
        """`service /NAME answers RESPONSE to REQUEST`."""
        types = dict(await asyncio.to_thread(self._link.graph.services)).get(values["name"])
        if not types:
            return missing("service.none")
        reply = await self._called(values["name"], types[0], values["request"])
        try:
            wanted = read_yaml(values["response"])
        except ValueError as error:
            return missing("answer.failed", reason=error)
        if _holds(wanted, reply):
            return HOLDS
        return missing("answer.other", answer=json.dumps(reply, ensure_ascii=False)[:_SHOWN])

    async def _parameter(self, values: _Values) -> Verdict:
        """`parameter /NODE NAME is VALUE`."""
        node, name = values["node"], values["name"]
        if node not in await asyncio.to_thread(self._link.node_names):
            return missing("node.none")
        kind, asked = "rcl_interfaces/srv/GetParameters", json.dumps({"names": [name]})
        reply = await self._called(_getter(node), kind, asked)
        found = cast("list[dict[str, Any]]", reply.get("values") or [{}])[0]
        kept = dict(enumerate(_VALUE_FIELDS)).get(int(found.get("type", 0)))
        if not kept:
            return missing("parameter.none")
        value = found.get(kept)
        text = str(value).lower() if isinstance(value, bool) else str(value)
        wanted = values["value"].strip("\"'")
        return HOLDS if is_same(wanted, text) else missing("parameter.other", value=text[:_SHOWN])

    async def _called(self, name: str, type_name: str, text: str) -> dict[str, Any]:
        """Raises: StudioError: Its type is not known here: no student's node is asked for it."""
        asked = _Request(name, type_name, text)
        kind = self._link.types.service(type_name)
        request = await asyncio.to_thread(ServiceRequest, self._link, asked, kind)
        try:
            return json.loads(await request.answer(_CALL_S))
        finally:
            await asyncio.to_thread(request.close)


def _service_of(check: Check) -> str:
    """Return the service that is called for a check."""
    return check.values["name"] if check.kind == "answers" else _getter(check.values["node"])


def _getter(node: str) -> str:
    """Return the service of a node that reads its parameters."""
    return f"{node}/get_parameters"


def _holds(wanted: object, found: object) -> bool:
    """Whether an answer has what is wanted; fields that are not named may have any value."""
    if isinstance(wanted, dict):
        fields = cast("dict[object, object]", wanted)
        return isinstance(found, dict) and all(
            name in found and _holds(value, cast("dict[object, object]", found)[name])
            for name, value in fields.items()
        )
    if isinstance(wanted, list):
        items = cast("list[object]", wanted)
        return (
            isinstance(found, list)
            and len(cast("list[object]", found)) == len(items)
            and all(map(_holds, items, cast("list[object]", found)))
        )
    if isinstance(wanted, bool) or isinstance(found, bool):
        return wanted is found
    return is_same(str(wanted), str(found))


def _with_qos(values: _Values, ends: list[GraphEndpoint], none: str) -> Verdict:
    if not ends:
        return missing(none)
    found = [(one.qos.reliability.name.lower(), one.qos.durability.name.lower()) for one in ends]
    durability = values.get("durability")
    if any(
        reliability == values["reliability"] and durability in {None, durable}
        for reliability, durable in found
    ):
        return HOLDS
    return missing("qos.other", qos=" ".join(found[0]))


_FORMS: Final[dict[str, Callable[[GraphChecks, _Values], Verdict]]] = {
    "node": GraphChecks.node,
    "topic_type": GraphChecks.topic_type,
    "service_type": GraphChecks.service_type,
    "action_type": GraphChecks.action_type,
    "servers": GraphChecks.servers,
    "publishers": GraphChecks.publishers,
    "subscriptions": GraphChecks.subscriptions,
    "published": GraphChecks.published,
    "subscribed": GraphChecks.subscribed,
    "rate": GraphChecks.rate,
    "tf": GraphChecks.tf,
}
