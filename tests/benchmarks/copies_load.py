"""Students with a copy each, in one process: `python -m ... JOB`.

Each has the two lanes of their page. It says a line of JSON once all copies are open, and one as
the answer to each line of stdin: `work S`, in which most edit a property of their copy every two
seconds and the others write one xacro bomb after the other; `leave`; and `return N`, in which so
many come back to their copies, one after the other.
"""

from __future__ import annotations

import asyncio
import itertools
import json
import random
import sys
import time
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final

from websockets.asyncio.client import ClientConnection, connect
from websockets.typing import Origin, Subprotocol

from tests.support.hostile import chain

if TYPE_CHECKING:
    from collections.abc import AsyncIterator

EDIT_EVERY_S: Final = 2.0
BOMB_REST_S: Final = 1.0
"""Between the refusal of a bomb and the next."""
_PATIENCE_S: Final = 120.0
_LETTERS: Final = "abcdefghijklmnopqrstuvwxyz"
_LOOPS: Final = "".join(f"[[{name}, {name}] for {name} in " for name in _LETTERS)
_MACROS: Final = '<xacro:macro name="m0"><x/></xacro:macro>' + "".join(
    f'<xacro:macro name="m{n + 1}"><xacro:m{n}/><xacro:m{n}/></xacro:macro>' for n in range(40)
)
BOMBS: Final = (
    f"{_MACROS}<xacro:m40/>",
    f'<x v="${{len(str({_LOOPS}[1]{"]" * 26}))}}"/>',
    chain("p", "${[1]}", "${[@, @]}") + '<x v="${len(str(p40))}"/>',
    chain("t", "abcdefgh", "${@}${@}") + '<x v="${t40}"/>',
    "<x v=\"${'a'*1000000}\"/>" * 600,
    '<xacro:macro name="r"><xacro:r/><xacro:r/></xacro:macro><xacro:r/>',
)
"""Macros and loops in each other, a list and a text that double, much text, an endless macro."""


@dataclass(frozen=True)
class Job:
    """Where to come, and who comes; the last `bombers` write bombs."""

    port: int
    document: str
    cookies: list[str]
    bombers: int


@dataclass
class Student:
    """One of them, with the lanes of their page."""

    job: Job
    cookie: str
    copy: str = ""
    sites: dict[str, Any] = field(default_factory=dict[str, Any])
    edits_ms: list[float] = field(default_factory=list[float])
    bombs_ms: list[float] = field(default_factory=list[float])
    expanded: int = 0
    """Bombs that were not refused."""

    def __post_init__(self) -> None:
        self._requests = itertools.count(1)
        self._scene_reader: asyncio.Task[None] | None = None

    async def open(self) -> None:
        """Have a copy, and look at it."""
        self._lane = await self._connected("/control")
        await self._send("open_copy", self.job.document)
        self.copy = (await self._until("opened"))["document"]
        await self._watch()

    async def come_back(self) -> float:
        """Look at the copy again; ms until the whole of its state is there, beside the lane."""
        self._lane = await self._connected("/control")
        await self._until("hello")
        begin_s = time.perf_counter()
        await self._watch()
        return (time.perf_counter() - begin_s) * 1e3

    async def leave(self) -> None:
        """Close the page."""
        await self._lane.close()
        await self._scene.close()
        if self._scene_reader is not None:
            await self._scene_reader

    async def edit(self, end_s: float) -> None:
        """Edit at the pace of a person."""
        await asyncio.sleep(random.random() * EDIT_EVERY_S)
        name = next(one for one in self.sites if one.endswith("wheel_radius"))
        site = self.sites[name]
        for number in itertools.count():
            begin_s = time.perf_counter()
            if begin_s > end_s:
                return
            text = f"{0.08 + 0.002 * (number % 20 + 1):.3f}"
            await self._send("edit_site", self.copy, site=site, text=text, gesture=f"{number}")
            await self._until("built")
            self.edits_ms.append((time.perf_counter() - begin_s) * 1e3)
            await self._listen(begin_s + EDIT_EVERY_S)

    async def bomb(self, first: int, end_s: float) -> None:
        """Write one bomb after the other in the place of the one before."""
        before = ""
        for number in itertools.count(first):
            if time.perf_counter() > end_s:
                return
            await self._send("get_text", self.copy, file=self._file)
            told = await self._until("text")
            start = told["text"].rindex(before or "</robot>")
            bomb = f"<!-- {number} -->{BOMBS[number % len(BOMBS)]}"
            change = {"start": start, "end": start + len(before), "text": bomb}
            begin_s = time.perf_counter()
            await self._send(
                "edit_text", self.copy, file=told["file"], version=told["version"], changes=[change]
            )
            self.expanded += (await self._until("built"))["ok"]
            self.bombs_ms.append((time.perf_counter() - begin_s) * 1e3)
            before = bomb
            await self._listen(time.perf_counter() + BOMB_REST_S)

    async def _watch(self) -> None:
        await self._send("watch", self.copy)
        built = robot = False
        async for event in self._events():
            robot |= event["type"] == "robot"
            built |= event["type"] == "built"
            if event["type"] == "document":
                self._file = event["path"]
            if robot and self.sites and event["type"] in {"built", "done"}:
                break
        self._scene = await self._connected(f"/d/{self.copy}/viser", "viser-v1.1.1")
        self._scene_reader = asyncio.create_task(self._read_scene())

    async def _read_scene(self) -> None:
        async for _ in self._scene:
            pass

    async def _listen(self, until_s: float) -> None:
        """Read what comes until then."""
        try:
            async with asyncio.timeout(until_s - time.perf_counter()):
                async for _ in self._events():
                    pass
        except TimeoutError:
            pass

    async def _until(self, kind: str) -> dict[str, Any]:
        async with asyncio.timeout(_PATIENCE_S):
            async for event in self._events():
                if event["type"] == kind:
                    return event
                if event["type"] == "refused":
                    raise RuntimeError(event["reason"])
        raise EOFError

    async def _events(self) -> AsyncIterator[dict[str, Any]]:
        while True:
            if isinstance(message := await self._lane.recv(), bytes):
                continue
            event: dict[str, Any] = json.loads(message)
            if event["type"] == "sites":
                self.sites |= {one["name"]: one["id"] for one in event["changed"]}
            yield event

    async def _send(self, kind: str, document: str, **fields: object) -> None:
        command = {"type": kind, "document": document, "request": next(self._requests)}
        await self._lane.send(json.dumps(command | fields))

    async def _connected(self, path: str, *subprotocols: str) -> ClientConnection:
        origin = f"127.0.0.1:{self.job.port}"
        return await connect(
            f"ws://{origin}{path}",
            origin=Origin(f"http://{origin}"),
            subprotocols=[Subprotocol(one) for one in subprotocols] or None,
            additional_headers={"Cookie": self.cookie},
            proxy=None,
            open_timeout=_PATIENCE_S,
            max_size=None,
        )


def _say(**told: object) -> None:
    sys.stdout.write(json.dumps(told) + "\n")
    sys.stdout.flush()


async def _run(job: Job) -> None:
    students = [Student(job, cookie) for cookie in job.cookies]
    editors, bombers = students[: -job.bombers], students[-job.bombers :]
    begin_s = time.perf_counter()
    await asyncio.gather(*(one.open() for one in students))
    _say(opened_s=time.perf_counter() - begin_s)
    while line := await asyncio.to_thread(sys.stdin.readline):
        word, _, number = line.strip().partition(" ")
        if word == "work":
            end_s = time.perf_counter() + float(number)
            await asyncio.gather(
                *(one.edit(end_s) for one in editors),
                *(one.bomb(at, end_s) for at, one in enumerate(bombers)),
            )
            _say(
                edits_ms=[ms for one in editors for ms in one.edits_ms],
                bombs_ms=[ms for one in bombers for ms in one.bombs_ms],
                expanded=sum(one.expanded for one in bombers),
            )
            for one in students:
                one.edits_ms.clear()
                one.bombs_ms.clear()
        elif word == "leave":
            await asyncio.gather(*(one.leave() for one in students))
            _say()
        elif word == "return":
            back = editors[: int(number)]
            _say(back_ms=[await one.come_back() for one in back])
            await asyncio.gather(*(one.leave() for one in back))


if __name__ == "__main__":
    asyncio.run(_run(Job(**json.loads(sys.argv[1]))))
