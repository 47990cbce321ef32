"""StudentNodes: who may join with nodes of their own, in which domain, and what is there."""

from __future__ import annotations

import asyncio
import ipaddress
import logging
from typing import TYPE_CHECKING, Final, Literal, TypeAlias

from studio.classroom.nodes.links import DomainLinks
from studio.classroom.nodes.pool import (
    POOL_SIZE,
    Pool,
    environment_of,
    pool_domains,
    powershell_line,
    shell_line,
)
from studio.classroom.nodes.router_process import CODEC, AskWell, OpenRouter, RouterOpen, Well
from studio.classroom.record import NodesRecord
from studio.debounce import Throttle
from studio.errors import CommandError, StudioError, WorkerError
from studio.live.connection.plan import planned_wire
from studio.protocol.commands import Commands, Limits, Scope
from studio.protocol.student_nodes import (
    NODES_SHOWN,
    TOPICS_SHOWN,
    GetMyGraph,
    GetNodeAccess,
    MyGraph,
    NodeAccess,
    OwnTopic,
    StartNodes,
    StopNodes,
    StudentNodesState,
)
from studio.ros.wire.certificates import new_secret
from studio.ros.wire.settings import WireSettings
from studio.settings import LOOPBACK_HOSTS, WireChoice
from studio.workers import Worker

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable

    from studio.live.connection.link import WireLink
    from studio.protocol.listeners import Listener
    from studio.ros.graph.endpoints import GraphEndpoint

_PORTS: Final = range(7448, 7458)
"""The first one is the one after that of rmw_zenoh's router."""
_START_S: Final = 20.0
_ANSWER_S: Final = 5.0
_LOOK_EVERY_S: Final = 2.0
_SOON_S: Final = 0.05
_PAUSE_S: Final = 0.25
_State: TypeAlias = Literal["off", "starting", "on", "failed"]
_log = logging.getLogger(__name__)


class StudentNodes:
    """Used on the event loop only.

    Args:
        listen: The address that the studio listens at, which is the router's as well.
        name: The address by which students reach this machine.
        kept: What was kept of an earlier run; `resume` goes on with it.
        keep: Keeps `record`.
        tell: Sends an event to everybody.
    """

    def __init__(
        self,
        listen: str,
        name: str,
        kept: NodesRecord,
        keep: Callable[[], Awaitable[None]],
        tell: Callable[[StudentNodesState], None],
    ) -> None:
        self._listen = "127.0.0.1" if listen == "localhost" else listen
        self._name = name or self._listen
        self._keep, self._tell = keep, tell
        self._state: _State = "off"
        self._trouble = ""
        self._pool: Pool | None = None
        """Made of the record, while nodes may join."""
        self.record = kept
        """What is to be kept."""
        self.choice: Callable[[], WireChoice] = WireChoice
        """The connection of the class's own ROS system, whose domain is left to it."""
        self._worker = Worker("nodes", "studio.classroom.nodes.router_process", CODEC)
        self._links = DomainLinks(self._open_link)
        self._turn = asyncio.Lock()
        self._watching: asyncio.Task[None] | None = None
        self._resuming: asyncio.Task[None] | None = None
        self._told = Throttle(self._send, first_s=_SOON_S, pause_s=_PAUSE_S)

    @property
    def router_pid(self) -> int | None:
        """The process of the router while it runs."""
        return self._worker.pid

    @property
    def link_count(self) -> int:
        """How many domains are looked into."""
        return len(self._links)

    def event(self) -> StudentNodesState:
        """Return the state as pages are sent it."""
        return StudentNodesState(
            state=self._state,
            endpoint=self._endpoint(self._name) if self._state == "on" else "",
            only_here=self._listen in LOOPBACK_HOSTS,
            given=len(self.record.given) + len(self.record.revoked),
            limit=POOL_SIZE,
            trouble=self._trouble,
        )

    # Switching

    def resume(self) -> None:
        """Go on where the studio was when it ended: lines that were copied before are valid."""
        if self.record.secret and self._pool is None and self._resuming is None:
            self._resuming = asyncio.create_task(self._resume())

    async def _resume(self) -> None:
        try:
            await self._begin()
        except StudioError as error:
            _log.warning("Students' own nodes cannot join any more: %s", error)

    async def start(self) -> None:
        """Make a new pool, and let nodes join.

        Raises:
            StudioError: No router can listen; the sentence says why.
        """
        if self._state in {"off", "failed"}:
            domains = pool_domains(planned_wire(self.choice()).domain)
            self.record = NodesRecord(secret=new_secret(), domains=domains)
            await self._begin()
            await self._keep()

    async def stop(self) -> None:
        """Let no nodes join; what was given out is worth nothing any more."""
        async with self._turn:
            await self._end()
            self._pool, self.record = None, NodesRecord()
            self._set("off")
        await self._keep()

    async def close(self) -> None:
        """End all; what was kept stays."""
        if self._resuming is not None:
            self._resuming.cancel()
            await asyncio.gather(self._resuming, return_exceptions=True)
        await self._told.close()
        await self._end()

    async def _begin(self) -> None:
        async with self._turn:
            await self._end()  # what is left of a router that failed
            self._set("starting")
            try:
                record = self.record
                self._pool = await asyncio.to_thread(Pool, record.secret, record.domains)
                await self._open()
            except Exception:
                self._pool, self.record = None, NodesRecord()
                if self._state == "starting":
                    self._set("off")
                raise
            self._watching = asyncio.create_task(self._look_after())

    async def _open(self) -> None:
        """Open the router anew, without those whose access was taken; the turn is ours."""
        assert self._pool is not None
        pool = self._pool
        left = [one for one in pool.domains if one not in self.record.revoked]
        users = [(pool.studio_name, pool.domains), *((pool.name_of(one), (one,)) for one in left)]
        ports = dict.fromkeys((*((self.record.port,) if self.record.port else ()), *_PORTS))
        places = tuple(self._place(self._listen, port) for port in ports)
        request = OpenRouter(places, pool.router, tuple(users))
        try:
            await self._worker.close()
            opened = await self._worker.ask(request, RouterOpen, _START_S)
        except WorkerError as error:
            opened = RouterOpen(reason=str(error))
        if opened.reason:
            self._set("failed", f"Nodes of students cannot join. {opened.reason}")
            raise CommandError(self._trouble)
        port = int(opened.endpoint.rpartition(":")[2])
        self.record = self.record.model_copy(update={"port": port})
        self._set("on")

    async def _end(self) -> None:
        watching, self._watching = self._watching, None
        if watching is not None:
            watching.cancel()
            await asyncio.gather(watching, return_exceptions=True)
        await self._links.close()
        await self._worker.close()

    async def _look_after(self) -> None:
        """Open the router again when its process has ended; nodes come back by themselves."""
        while True:
            await asyncio.sleep(_LOOK_EVERY_S)
            async with self._turn:
                try:
                    await self._worker.ask(AskWell(), Well, _ANSWER_S, starts=False)
                except WorkerError as error:
                    _log.warning("The students' router is started anew: %s", error)
                    try:
                        await self._open()
                    except CommandError as failure:
                        _log.warning("%s", failure)
                        return

    def _set(self, state: _State, trouble: str = "") -> None:
        self._state, self._trouble = state, trouble
        self._changed()

    def _changed(self) -> None:
        self._told.trigger()

    async def _send(self) -> None:
        self._tell(self.event())

    # People

    async def access(self, asker: Listener, request: int) -> NodeAccess:
        """Return what the asker's own nodes need; a domain is given to each who asks.

        Raises:
            CommandError: Access is off, or all domains are given out.
        """
        pool = self._opened()
        record = self.record
        domain = record.given.get(asker.person)
        if domain is None:
            used = {*record.given.values(), *record.revoked}
            domain = next((one for one in pool.domains if one not in used), None)
            if domain is None:
                raise CommandError(
                    f"All {POOL_SIZE} domains are given out: share one with a neighbour, or ask "
                    "the presenter to switch access for nodes off and on, which gives new ones."
                )
            given = {**record.given, asker.person: domain}
            self.record = record.model_copy(update={"given": given})
            self._changed()
            await self._keep()
        credentials = await asyncio.to_thread(pool.of, domain)
        endpoint = self._endpoint(self._name)
        variables = environment_of(endpoint, domain, credentials)
        return NodeAccess(
            request=request,
            domain=domain,
            endpoint=endpoint,
            shell=shell_line(variables),
            powershell=powershell_line(variables),
        )

    def has_access(self, person: str) -> bool:
        """Whether a person was given a domain."""
        return person in self.record.given

    async def revoke(self, person: str) -> None:
        """Take a person's access: the router starts anew without them, and all others come back.

        Their domain is given to nobody else.
        """
        given = dict(self.record.given)
        domain = given.pop(person, None)
        if domain is None:
            return
        revoked = (*self.record.revoked, domain)
        self.record = self.record.model_copy(update={"given": given, "revoked": revoked})
        async with self._turn:
            await self._links.close_one(domain)
            if self._state == "on":
                try:
                    await self._open()
                except CommandError as error:
                    _log.warning("%s", error)
        self._changed()
        await self._keep()

    async def link(self, person: str) -> WireLink | None:
        """Return a link into a person's domain, to be asked for anew whenever it is used.

        It is closed once nobody has asked for 30 s. None: they have no domain.

        Raises:
            StudioError: It cannot be reached now, or has too much in it.
        """
        domain = self.record.given.get(person)
        if domain is None:
            return None
        self._opened()
        return await self._links.get(domain)

    async def graph(self, asker: Listener, request: int) -> MyGraph:
        """Return what there is in the asker's domain.

        Raises:
            StudioError: They have none, or it cannot be reached.
        """
        self._opened()
        domain = self.record.given.get(asker.person)
        if domain is None:
            raise CommandError("Your nodes have no domain yet: ask for the line to copy first.")
        link = await self._links.get(domain)
        return await asyncio.to_thread(_graph_of, link, request)

    def _opened(self) -> Pool:
        if self._state != "on" or self._pool is None:
            raise CommandError(
                "Own nodes cannot join now: ask the presenter to switch their access on."
            )
        return self._pool

    # Where

    def _endpoint(self, host: str) -> str:
        return self._place(host, self.record.port)

    def _place(self, host: str, port: int) -> str:
        return f"tls/[{host}]:{port}" if ":" in host else f"tls/{host}:{port}"

    def _open_link(self, domain: int, changed: Callable[[], None]) -> WireLink:
        from studio.live.connection.link import WireLink  # noqa: PLC0415 - imports zenoh

        pool = self._opened()
        settings = WireSettings(
            connect=(self._endpoint(_near(self._listen)),),
            domain=domain,
            profile=planned_wire(self.choice()).profile,
            overrides=pool.studio.of_session(),
        )
        return WireLink(WireChoice(router="off"), changed, settings)


def _near(listen: str) -> str:
    """Return the address by which this machine reaches what listens there."""
    try:
        address = ipaddress.ip_address(listen)
    except ValueError:
        return listen
    if not address.is_unspecified:
        return listen
    return "127.0.0.1" if address.version == 4 else "::1"


def _graph_of(link: WireLink, request: int) -> MyGraph:
    link.graph.settle()
    nodes = sorted(set(link.node_names()))
    topics = [
        OwnTopic(
            name=name,
            types=tuple(types),
            publishers=_others(link, link.graph.publishers(name)),
            subscriptions=_others(link, link.graph.subscriptions(name)),
        )
        for name, types in sorted(link.graph.topics())
    ]
    topics = [one for one in topics if one.publishers or one.subscriptions]
    return MyGraph(
        request=request,
        domain=link.domain,
        nodes=tuple(nodes[:NODES_SHOWN]),
        topics=tuple(topics[:TOPICS_SHOWN]),
        more=max(0, len(nodes) - NODES_SHOWN) + max(0, len(topics) - TOPICS_SHOWN),
    )


def _others(link: WireLink, ends: list[GraphEndpoint]) -> int:
    return sum(one.node.zid != link.zid for one in ends)


_SELDOM: Final = Limits(bytes_max=1_000, per_second=5)

COMMANDS: Final = Commands[StudentNodes](Scope.STUDIO)
COMMANDS.presenter(StartNodes, lambda nodes, _, __: nodes.start())
COMMANDS.presenter(StopNodes, lambda nodes, _, __: nodes.stop())
COMMANDS.student(GetNodeAccess, lambda nodes, c, who: nodes.access(who, c.request), limits=_SELDOM)
COMMANDS.student(GetMyGraph, lambda nodes, c, who: nodes.graph(who, c.request), limits=_SELDOM)
