"""ToolPublishing: what tools of the 3D view point at, published or sent as goals."""

from __future__ import annotations

import asyncio
import json
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

from studio.errors import CommandError
from studio.live.panels.operations import Begins
from studio.ros.duration import NANOSECONDS
from studio.rviz.tools import (
    ACTION,
    COVARIANCES,
    DEPTH,
    DURABILITY,
    HISTORY,
    NAVIGATE_TO_POSE,
    POINT,
    POSE_WITH_COVARIANCE,
    RELIABILITY,
    SEND_AS,
    TOPIC,
    kind_of,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Container

    from studio.live.connection.link import WireLink
    from studio.live.connection.ros_connection import RosConnection
    from studio.live.displays.document_tools import ToolUse
    from studio.live.panels.goals import ActionGoals
    from studio.live.panels.tool_work import ToolPublisher
    from studio.rviz.tools import ToolSpec

_PUBLISHERS_MAX: Final = 100
_LISTENER_PATIENCE_S: Final = 1.0
"""So long a new publisher waits for a subscription, and a goal for its server."""
_YAW: Final = 5


@dataclass(frozen=True, slots=True)
class TopicSettings:
    """A topic, its type, and the QoS by RViz's words."""

    topic: str
    message_type: str
    depth: int
    history: str
    reliability: str
    durability: str


@dataclass(frozen=True, slots=True)
class ToolSent:
    """What was sent.

    Attributes:
        name: Of the topic or the action.
        subscriptions: Of the topic when it was published; 0: nobody heard it.
        operation: Of a goal: its number among goals; else 0.
    """

    name: str
    subscriptions: int = 0
    operation: int = 0


class ToolPublishing:
    """Publishes for tools; a publisher stays until its tool goes, or has another topic or QoS.

    Used on the event loop only.
    """

    def __init__(self, wire: RosConnection, goals: ActionGoals) -> None:
        self._wire, self._goals = wire, goals
        self._publishers: dict[tuple[str, str], ToolPublisher] = {}
        """By document and tool, the one used last at the end."""
        self._begins = Begins()
        self._turn = asyncio.Lock()
        self._closing: set[asyncio.Task[None]] = set()

    async def use(self, document: str, use: ToolUse, person: str) -> ToolSent:
        """Publish, or send a goal; return what was sent where.

        Raises:
            StudioError: It cannot be published, or the action is not served; nothing was sent.
        """
        with self._begins.of(person) as begin:
            link = await self._wire.link()

            def check() -> None:
                if not begin.may_go_on:
                    raise CommandError(
                        "The robot was stopped, or control went to somebody else: nothing was sent."
                    )

            if await self._goes_to_action(use.tool, link):
                check()
                return await self._send_goal(use)
            return await self._publish(document, use, link, check)

    def release(self, may_go_on: Callable[[str], bool]) -> None:
        """Send nothing of what these persons are about to."""
        self._begins.release(may_go_on)

    def keep_only(self, document: str, tools: Container[str]) -> None:
        """Close the publishers of the tools that a document has no more."""
        for key in tuple(self._publishers):
            if key[0] == document and key[1] not in tools:
                self._close(self._publishers.pop(key))

    async def let_go(self) -> None:
        """Close all publishers: the connection is about to end."""
        publishers, self._publishers = tuple(self._publishers.values()), {}
        for one in publishers:
            self._close(one)
        await asyncio.gather(*self._closing)

    def _close(self, publisher: ToolPublisher) -> None:
        closing = asyncio.create_task(asyncio.to_thread(publisher.close))
        self._closing.add(closing)
        closing.add_done_callback(self._closing.discard)

    async def _goes_to_action(self, tool: ToolSpec, link: WireLink) -> bool:
        if kind_of(tool.kind).kind != "SetGoal" or (send_as := tool.value(SEND_AS)) == "Topic":
            return False
        from studio.live.panels.requests import came_true, not_served, wire_name  # noqa: PLC0415

        name = wire_name(str(tool.value(ACTION)))

        def is_served() -> bool:
            return bool(link.graph.action_servers(name)) and NAVIGATE_TO_POSE in _types(link, name)

        if send_as == "Auto":
            return is_served()
        if not await came_true(is_served, _LISTENER_PATIENCE_S):
            raise not_served("action", name, NAVIGATE_TO_POSE, _types(link, name))
        return True

    async def _send_goal(self, use: ToolUse) -> ToolSent:
        name = str(use.tool.value(ACTION))
        goal = json.dumps({"pose": message_values(use)})
        return ToolSent(name, operation=await self._goals.send(name, NAVIGATE_TO_POSE, goal))

    async def _publish(
        self, document: str, use: ToolUse, link: WireLink, check: Callable[[], None]
    ) -> ToolSent:
        from studio.live.panels.requests import came_true  # noqa: PLC0415 - imports zenoh

        publisher = await self._publisher(document, use.tool, link)
        if not publisher.has_sent:  # later it knows of who subscribes
            await came_true(lambda: publisher.subscriptions() > 0, _LISTENER_PATIENCE_S)
        check()
        if publisher not in self._publishers.values():
            raise CommandError("The tool was changed or removed meanwhile: nothing was sent.")
        subscriptions = publisher.subscriptions()
        await asyncio.to_thread(publisher.send, message_values(use))
        return ToolSent(publisher.name, subscriptions)

    async def _publisher(self, document: str, tool: ToolSpec, link: WireLink) -> ToolPublisher:
        from studio.live.panels.tool_work import ToolPublisher  # noqa: PLC0415 - imports zenoh

        key, settings = (document, tool.id), settings_of(tool)
        async with self._turn:
            found = self._publishers.pop(key, None)
            if found is None or found.link is not link or found.settings != settings:
                if found is not None:
                    await asyncio.to_thread(found.close)
                found = await asyncio.to_thread(ToolPublisher, link, settings)
            self._publishers[key] = found
            if len(self._publishers) > _PUBLISHERS_MAX:
                await asyncio.to_thread(self._publishers.pop(next(iter(self._publishers))).close)
        return found


def settings_of(tool: ToolSpec) -> TopicSettings:
    """Return where a tool publishes, and how."""
    return TopicSettings(
        str(tool.value(TOPIC)),
        kind_of(tool.kind).message_type,
        int(tool.value(DEPTH)),
        *(str(tool.value(one)) for one in (HISTORY, RELIABILITY, DURABILITY)),
    )


def message_values(use: ToolUse) -> dict[str, Any]:
    """Return the fields of the message that a tool publishes."""
    second, nanosecond = divmod(use.stamp_ns, NANOSECONDS)
    header = {"stamp": {"sec": second, "nanosec": nanosecond}, "frame_id": use.frame}
    place = dict(zip("xyz", use.xyz, strict=True))
    message_type = kind_of(use.tool.kind).message_type
    if message_type == POINT:
        return {"header": header, "point": place}
    pose = {"position": place, "orientation": dict(zip("wxyz", use.wxyz, strict=True))}
    if message_type != POSE_WITH_COVARIANCE:
        return {"header": header, "pose": pose}
    covariance = [0.0] * 36
    for axis, name in zip((0, 1, _YAW), COVARIANCES, strict=True):
        covariance[7 * axis] = float(use.tool.value(name))
    return {"header": header, "pose": {"pose": pose, "covariance": covariance}}


def _types(link: WireLink, action: str) -> tuple[str, ...]:
    return tuple(dict(link.graph.actions()).get(action, ()))
