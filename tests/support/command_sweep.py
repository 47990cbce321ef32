"""Thousands of random commands at a real engine: `python -m tests.support.command_sweep`.

Ends with 1 when a command failed inside, or kept the event loop for longer than it may.
"""

from __future__ import annotations

import argparse
import asyncio
import gc
import json
import logging
import shutil
import sys
import tempfile
import time
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path
from random import Random
from typing import TYPE_CHECKING, Any, Final

from studio.documents.engine import Engine
from studio.documents.services import USED_LATER
from studio.protocol.roles import Role, Visitor
from studio.server.commands import answer
from studio.settings import Settings, WireChoice
from tests.support.command_fuzzer import WORDS, CommandFuzzer
from tests.support.loop_watch import Stall, stalls
from tests.support.open_documents import Ear, until

if TYPE_CHECKING:
    from collections.abc import Sequence

STALL_S: Final = 0.1
_MODELS: Final = Path(__file__).parents[2] / "models"
_AT_ONCE: Final = 8
_OPEN_MOST: Final = 3
_TOGETHER_WITHIN_S: Final = 120.0
_LONG_TEXT_BYTES: Final = 1_000_000
_STALLS_SHOWN: Final = 20


@dataclass
class Swept:
    """What became of the commands: how many ended how, what failed inside, the longest stalls."""

    ends: Counter[str] = field(default_factory=Counter[str])
    failures: list[str] = field(default_factory=list[str])
    stalls: list[tuple[Stall, str]] = field(default_factory=list[tuple[Stall, str]])
    """Each with the commands under way then."""


class _SweepEar(Ear):
    """Reads refusals only: reading long answers is no work of the engine."""

    def controls(self, document: str) -> bool:
        return Visitor(self.role).controls(document)

    def sees(self, document: str) -> bool:
        return Visitor(self.role).sees(document)

    def post(self, data: bytes, *, binary: bool = False, key: str | None = None) -> None:
        if data.startswith(b'{"type":"refused"'):
            super().post(data, binary=binary, key=key)


class _Log(logging.Handler):
    """Keeps what the door says of commands that failed."""

    def __init__(self) -> None:
        super().__init__(logging.ERROR)
        self.said: list[str] = []
        self.setFormatter(logging.Formatter())

    def emit(self, record: logging.LogRecord) -> None:
        self.said.append(self.format(record))


class _Sweep:
    def __init__(self, made: Engine, folder: Path, random: Random, stall_s: float) -> None:
        self._engine, self._folder, self._random = made, folder, random
        self._stall_s = stall_s
        self._ears = (_SweepEar(), _SweepEar(), _SweepEar(Role.GUEST))
        self._fuzzer = CommandFuzzer(random, {})
        self._under_way: list[str] = []
        self.swept = Swept()

    async def run(self, count: int) -> Swept:
        """Send so many commands, some at once."""
        for ear in self._ears:
            self._engine.attach(ear)
        with stalls(self._stall_s, self._notice):
            await self._send_all(count)
        return self.swept

    async def _send_all(self, count: int) -> None:
        for number in range(0, count, _AT_ONCE):
            await self._ready()
            texts = [self._text(number + one) for one in range(min(_AT_ONCE, count - number))]
            self._under_way = texts
            async with asyncio.timeout(_TOGETHER_WITHIN_S):
                await asyncio.gather(*(self._send(text) for text in texts))

    def _notice(self, stall: Stall) -> None:
        self.swept.stalls.append((stall, " ".join(kinds(self._under_way))))

    async def _ready(self) -> None:
        """Have a document open, not many, and its names known to the fuzzer."""
        while len(self._engine.documents) > _OPEN_MOST:
            name = self._random.choice(list(self._engine.documents))
            await self._send(
                json.dumps({"type": "close_document", "document": name, "discard": True})
            )
        if not self._engine.documents:
            robot = self._random.choice(sorted(self._folder.rglob("*.urdf.xacro")))
            document = self._engine.document(await self._engine.open_path(robot, {}))
            await document.opened()
            await until(lambda: all(one in sys.modules for one in USED_LATER))
            for ear in self._ears:
                await answer(self._engine, ear, self._watch(document.id))
        self._fuzzer.known = self._known()
        for ear in self._ears:
            ear.events.clear()

    @staticmethod
    def _watch(document: str) -> bytes:
        return json.dumps({"type": "watch", "document": document}).encode()

    def _known(self) -> dict[str, Sequence[str]]:
        document = next(iter(self._engine.documents.values()))
        files = list(document.last_run.files) or [document.path]
        robot = document.model.robot
        names = [*robot.links, *robot.joints, *document.sources.arguments]
        parts = [*(f"link:{one}" for one in robot.links), *(f"joint:{one}" for one in robot.joints)]
        folder = [str(self._folder)]
        sites = list(document.sites.sites)
        return {
            "document": list(self._engine.documents),
            "file": files,
            "path": [*files, *folder],
            "folder": folder,
            "part": parts or [""],
            "site": sites or [*WORDS[:4]],
            "name": [*names, *WORDS[:6]],
            "gesture": ["", "drag", "type"],
            "frame": list(robot.links) or [""],
        }

    def _text(self, number: int) -> str:
        return json.dumps(self._fuzzer.command(number + 1))

    async def _send(self, text: str) -> None:
        ear = self._random.choice(self._ears)
        await answer(self._engine, ear, text.encode())
        kind = json.loads(text)["type"]
        request = json.loads(text).get("request", 0)
        for event in ear.events:
            if event["type"] == "refused" and event["request"] == request:
                self.swept.ends[event["kind"]] += 1
                if event["kind"] == "InternalError":
                    self.swept.failures.append(f"{kind}: {text[:1000]}")
                return
        self.swept.ends["done"] += 1


def kinds(texts: Sequence[str]) -> list[str]:
    """The kinds of these commands."""
    return [json.loads(one)["type"] for one in texts]


async def sweep(folder: Path, seed: int, count: int, stall_s: float = STALL_S) -> Swept:
    """Send `count` commands that `seed` makes to an engine whose robots are copies in `folder`."""
    robots = folder / "robots"
    shutil.copytree(_MODELS, robots)
    long_text = next(iter(sorted(robots.rglob("*.urdf.xacro"))))
    filling = f"<!-- {'wheel_radius ' * 8} -->\n" * (_LONG_TEXT_BYTES // 114)
    long_text.with_name("long.urdf.xacro").write_text(f"<robot name='long'>\n{filling}</robot>\n")
    settings = Settings(data_folder=folder / "data", wire=WireChoice(router="off"))
    settings.data_folder.mkdir()
    log, door = _Log(), logging.getLogger("studio.server.commands")
    door.addHandler(log)
    made = Engine(settings)
    await made.start()
    gc.collect()
    gc.freeze()  # as `studio` does: a collection then looks at what came later
    try:
        swept = await _Sweep(made, robots, Random(seed), stall_s).run(count)
    finally:
        await made.close()
        door.removeHandler(log)
    swept.failures += log.said
    return swept


def main() -> int:
    """Sweep, and print what came of it."""
    parser = argparse.ArgumentParser(prog="make sweep", description="Random commands at an engine.")
    parser.add_argument("--count", type=int, default=20_000)
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        began_s = time.perf_counter()
        swept = asyncio.run(sweep(Path(folder), given.seed, given.count))
        took_s = time.perf_counter() - began_s
    said: list[Any] = [f"{given.count} commands of seed {given.seed} in {took_s:.0f} s"]
    said += [f"  {count:6} {end}" for end, count in swept.ends.most_common()]
    said += [f"Failed inside: {one}" for one in swept.failures]
    longest = sorted(swept.stalls, key=lambda one: one[0].took_s)[-_STALLS_SHOWN:]
    said += [f"Stalled {stall}\nUnder way: {what}" for stall, what in longest]
    sys.stdout.write("\n".join(said) + "\n")
    return 1 if swept.failures or swept.stalls else 0


if __name__ == "__main__":
    sys.exit(main())
