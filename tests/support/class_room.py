"""A class with an open rover, for tests: its people, and what they ask through the door."""

from __future__ import annotations

import asyncio
import shutil
from contextlib import asynccontextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from studio.classroom.classroom import Classroom, Reach
from studio.documents.engine import COMMANDS, Engine
from studio.protocol.commands import demand
from studio.protocol.copies import OpenCopy
from studio.protocol.documents import Watch
from studio.protocol.roles import Role, Visitor
from studio.settings import Settings
from tests.support.open_documents import Ear, until

if TYPE_CHECKING:
    from collections.abc import AsyncGenerator, Callable, Coroutine

    from studio.classroom.members import Member
    from studio.documents.document import Document
    from studio.protocol import Command

MODELS = Path(__file__).resolve().parents[2] / "models"


class Page(Ear):
    """A page of a member, or of the presenter."""

    def __init__(self, who: Member | Visitor) -> None:
        super().__init__(who.role)
        self.who, self.person = who, who.person

    def sees(self, document: str) -> bool:
        """What its person may look at."""
        return self.who.sees(document)


class Room:
    """An engine with an open rover, a class, and what its people ask through the door."""

    def __init__(self, engine: Engine, shared: Document) -> None:
        self.engine, self.shared = engine, shared
        self.classroom = engine.classroom
        self.presenter = self.page(Visitor(Role.PRESENTER, control=self.classroom.control))

    def page(self, who: Member | Visitor) -> Page:
        """A page that somebody opened."""
        made = Page(who)
        self.engine.attach(made)
        return made

    async def student(self, name: str) -> Page:
        """The page of a student who joins."""
        joined = await self.classroom.join(name, self.classroom.admission.code, "", "")
        return self.page(joined)

    async def ask(self, page: Page, command: Command) -> None:
        """As the control lane carries a command out."""
        demand(page.who, COMMANDS[type(command)].permission, command.document)
        await self.engine.execute(command, page)

    async def copy(self, page: Page) -> Document:
        """Their copy, open and watched."""
        await self.ask(page, OpenCopy(document=self.shared.id))
        name = page.last("opened")["document"]
        await self.ask(page, Watch(document=name))
        made = self.engine.document(name)
        await made.opened()
        await until(lambda: made.last_run.expansion is not None)
        return made


@asynccontextmanager
async def room(tmp_path: Path, **settings: object) -> AsyncGenerator[Room]:
    """A class in a studio with the rover; `settings` as of `Settings`."""
    data = tmp_path / "data"
    data.mkdir(exist_ok=True)
    classroom = Classroom(data / "class-1.json", Reach(("http://robots.example/",)))
    chosen = Settings(data_folder=data, **settings)  # type: ignore[arg-type]
    engine = Engine(chosen, classroom)
    await classroom.start()
    rover = tmp_path / "rover_description"
    if not rover.exists():
        shutil.copytree(MODELS / "rover_description", rover)
    try:
        entry = rover / "urdf/rover.urdf.xacro"
        shared = engine.document(await engine.open_path(entry, {"wheels": "road"}))
        await shared.opened()
        engine.copies.services.quiet_s = 0.05  # their checks wait for no person
        yield Room(engine, shared)
    finally:
        await engine.close()


def run(
    tmp_path: Path, work: Callable[[Room], Coroutine[Any, Any, None]], **settings: object
) -> None:
    """Do some work in such a class."""

    async def begin() -> None:
        async with room(tmp_path, **settings) as made:
            await work(made)

    asyncio.run(begin())
