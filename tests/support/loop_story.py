"""An edit loop over one small robot, told as a story: edits, questions, and falls of its worker."""

from __future__ import annotations

import asyncio
import os
import signal
from contextlib import asynccontextmanager, suppress
from typing import TYPE_CHECKING, NamedTuple

from studio.description.client import EXPANSION_TIMEOUT_S, DescriptionWorker
from studio.description.editing.sources import Sources
from studio.description.origins.origin_values import PartOrigin, PartOriginQuery
from studio.description.values import Edit, Expansion
from studio.documents.runs import Runs
from studio.packages.roots import ServedRoots
from tests.support.descriptions import policy_for, robot, write
from tests.support.open_documents import Ear, until

if TYPE_CHECKING:
    from collections.abc import AsyncGenerator
    from pathlib import Path

    from studio.description.requests import Query, Reply
    from studio.description.session import Answer
    from studio.description.values import (
        ArgumentsRequest,
        EditRequest,
        OpenRequest,
        ReadPolicy,
        ReloadRequest,
    )
    from studio.documents.runs import Outcome

SOURCE = robot(
    '<xacro:arg name="side" default="left"/><xacro:property name="m" value="1"/>'
    '<link name="$(arg side)"><inertial><mass value="${m * 2}"/></inertial></link>'
)
AT = SOURCE.index('"1"') + 1
ORIGIN = PartOriginQuery("link:left")


class Target(NamedTuple):
    """What is run, and what it may read."""

    path: str
    policy: ReadPolicy


def target_for(file: Path) -> Target:
    """A file that may read its own folder."""
    return Target(str(file), policy_for(file.parent))


class NotedWorker(DescriptionWorker):
    """A worker that notes what it was asked, and which edits and questions it has answered."""

    def __init__(self, timeout_s: float = EXPANSION_TIMEOUT_S) -> None:
        super().__init__(timeout_s)
        self.asked = 0
        self.answered: list[str] = []

    async def open(self, request: OpenRequest) -> Answer:
        self.asked += 1
        return await super().open(request)

    async def set_arguments(self, request: ArgumentsRequest) -> Answer:
        self.asked += 1
        return await super().set_arguments(request)

    async def reload(self, request: ReloadRequest) -> Answer:
        self.asked += 1
        return await super().reload(request)

    async def edit(self, request: EditRequest) -> Answer:
        self.asked += 1
        answer = await super().edit(request)
        self.answered.append("edit")
        return answer

    async def query(self, query: Query) -> Reply:
        self.asked += 1
        reply = await super().query(query)
        self.answered.append(type(query).__name__)
        return reply


class LoopStory:
    """A loop over one open robot, and what came of its runs."""

    def __init__(self, file: Path, worker: NotedWorker) -> None:
        roots = ServedRoots([file.parent])
        self._worker, self._asked_before = worker, 0
        self.file = file
        self.outcomes: list[Outcome] = []
        self.sources = Sources(roots.read, roots.resolve, lambda _: True, {})
        self.loop = Runs(
            worker,
            self.sources,
            target_for(file),
            lambda one, _: self.outcomes.append(one),
        )

    @property
    def pid(self) -> int:
        """Of the worker's process."""
        assert self.loop.worker_pid is not None
        return self.loop.worker_pid

    async def edit(self, digit: str = "7") -> None:
        """Write another number."""
        await self.splice(Edit(str(self.file), AT, AT + 1, digit.encode()))

    async def drag(self, digit: str) -> None:
        """Write another number, as a slider does that is held."""
        await self.splice(Edit(str(self.file), AT, AT + 1, digit.encode()), in_gesture=True)

    async def splice(self, edit: Edit, *, in_gesture: bool = False) -> None:
        """Change the text."""
        self.sources.edit(edit, "m")
        await self.loop.edit((edit,), in_gesture=in_gesture)

    async def pass_argument(self) -> None:
        """Run with another argument."""
        self.sources.set_argument("side", "left")
        await self.loop.arguments_changed()

    async def reload(self) -> None:
        """Run with the file read anew."""
        await self.loop.reload((str(self.file),))

    async def ask(self) -> None:
        """Ask, and be answered."""
        assert isinstance(await self.loop.ask(ORIGIN, Ear()), PartOrigin)

    def asked(self, query: Query, ear: Ear | None = None) -> asyncio.Future[Reply]:
        """The reply to a question."""
        return asyncio.ensure_future(self.loop.ask(query, ear or Ear()))

    def stop(self) -> None:
        """Have the process stand still: it answers nothing."""
        self._asked_before = self._worker.asked
        os.kill(self.pid, signal.SIGSTOP)

    async def until_asked(self) -> None:
        """Wait until the process that stands still was asked something."""
        await until(lambda: self._worker.asked > self._asked_before)

    def go_on(self) -> None:
        """Have it go on."""
        os.kill(self.pid, signal.SIGCONT)

    async def fall(self) -> None:
        """Kill the process, and wait until that was noticed."""
        pid = self.pid
        os.kill(pid, signal.SIGKILL)
        await until(lambda: not _is_there(pid))

    def check(self, mass: str) -> None:
        """Every run gave a robot, the last one with this mass."""
        runs = [one for one in self.outcomes if isinstance(one, Expansion)]
        assert len(runs) == len(self.outcomes)
        written = [part.xml for one in runs for part in one.changed_parts]
        assert f'value="{mass}"' in written[-1]


def _is_there(pid: int) -> bool:
    with suppress(ProcessLookupError):
        os.kill(pid, 0)
        return True
    return False


@asynccontextmanager
async def loop_story(folder: Path, worker: NotedWorker | None = None) -> AsyncGenerator[LoopStory]:
    """A story whose robot is open."""
    file = write(folder, {"a.xacro": SOURCE})
    story = LoopStory(file, worker or NotedWorker())
    try:
        await story.loop.reopen()
        yield story
    finally:
        await story.loop.close()
