"""Rejoining: a studio that was connected when it ended joins that ROS 2 system again by itself."""

from __future__ import annotations

import asyncio
import logging
from contextlib import suppress
from typing import TYPE_CHECKING, Final

import msgspec

from studio.errors import NoRouterError, StudioError
from studio.live.connection.plan import planned_wire
from studio.ros.wire.endpoints import ProbeResult, parse_endpoint, probe
from studio.settings import WireChoice

if TYPE_CHECKING:
    from pathlib import Path

    from studio.live.connection.link import WireLink
    from studio.live.connection.ros_connection import RosConnection

FILE: Final = "connection.json"
_LIMIT_BYTES: Final = 64 << 10
_PAUSE_S: Final = 2.0
"""Between two attempts to reach a router that is away."""

_log = logging.getLogger(__name__)


class KeptConnection(msgspec.Struct, frozen=True, omit_defaults=True):
    """The connection that the studio had when it ended."""

    started_for: str = ""
    """The address given on the command line; with another one, this is not connected again."""
    connect: tuple[str, ...] = ()
    """As in a WireChoice, like domain and distribution: a person may have chosen them."""
    domain: int | None = None
    distro: str = ""
    had_own_router: bool = False
    """The router was one that this studio started, and so starts again."""


class Rejoining:
    """Keeps in the data folder where the studio is connected; joins there again after a restart.

    A router that does not answer is waited for, until somebody connects elsewhere or disconnects.
    """

    def __init__(self, wire: RosConnection, data_folder: Path) -> None:
        self._wire = wire
        self._path = data_folder / FILE
        self._started_for = place_of(wire.choice)
        self._joining: asyncio.Task[None] | None = None
        self._writing: asyncio.Task[None] | None = None
        self._unwritten: KeptConnection | None = None
        wire.on_link = self._keep

    def begin(self, *, always: bool = False) -> None:
        """Join where the studio was connected last; `always`: also where it never was."""
        self._joining = asyncio.create_task(self._join(always=always))

    async def close(self) -> None:
        """Wait for no router any more."""
        if self._joining is not None:
            self._joining.cancel()
            await asyncio.gather(self._joining, return_exceptions=True)
        if self._writing is not None:
            await self._writing

    async def _join(self, *, always: bool) -> None:
        kept = await asyncio.to_thread(self._read)
        is_same = kept.started_for != "" and kept.started_for == self._started_for
        if is_same:
            self._wire.choose(_chosen_again(self._wire.choice, kept))
        elif not always:
            return
        may_start = always or kept.had_own_router
        while self._wire.current is None:
            if may_start or await asyncio.to_thread(_answers, self._wire.choice):
                may_start = False
                try:
                    await self._wire.link()
                except NoRouterError:
                    pass  # it may come, and is waited for
                except StudioError as error:
                    _log.info("Not connected again: %s", error)
                    return
            await asyncio.sleep(_PAUSE_S)

    def _keep(self, link: WireLink | None) -> None:
        """Keep where there is a connection now, or that a person ended it."""
        if link is None:
            if self._joining is not None:
                self._joining.cancel()
            self._unwritten = KeptConnection()
        else:
            now = self._wire.choice
            self._unwritten = KeptConnection(
                self._started_for, now.connect, now.domain, now.distro, link.has_own_router
            )
        if self._writing is None or self._writing.done():
            self._writing = asyncio.create_task(self._write())

    async def _write(self) -> None:
        while self._unwritten is not None:
            kept, self._unwritten = self._unwritten, None
            try:
                await asyncio.to_thread(self._path.write_bytes, msgspec.json.encode(kept))
            except OSError as error:
                _log.warning("The connection is not kept in %s: %s.", self._path, error.strerror)

    def _read(self) -> KeptConnection:
        """Return the connection kept; an empty one if there is none or the file cannot be read."""
        with suppress(OSError, msgspec.MsgspecError, UnicodeDecodeError, RecursionError):
            if self._path.stat().st_size <= _LIMIT_BYTES:
                return msgspec.json.decode(self._path.read_bytes(), type=KeptConnection)
        return KeptConnection()


def _chosen_again(now: WireChoice, kept: KeptConnection) -> WireChoice:
    """Return what was chosen then; the command line now decides whether to start a router."""
    router = now.router if kept.connect == now.connect or now.router == "off" else "auto"
    return WireChoice(router, kept.connect, kept.domain, kept.distro)


def place_of(choice: WireChoice) -> str:
    """Return the address and domain of a choice as one text; empty if the settings are invalid."""
    try:
        planned = planned_wire(choice)
    except StudioError:
        return ""
    return f"{', '.join(planned.connect)} domain {planned.domain}"


def _answers(choice: WireChoice) -> bool:
    """Whether a router is there already; waits for a while where nothing answers."""
    try:
        places = [parse_endpoint(one) for one in planned_wire(choice).connect]
    except StudioError:
        return False
    return any(probe(one) in {ProbeResult.ZENOH, ProbeResult.TLS} for one in places)
