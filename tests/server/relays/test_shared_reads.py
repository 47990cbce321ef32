"""What many pages ask at once goes to the origin once, and is never older than what they know."""

from __future__ import annotations

import asyncio
import json
from typing import TYPE_CHECKING, Any

import pytest

from studio.errors import OriginAwayError
from studio.protocol.roles import Role
from studio.protocol.texts import GetText
from studio.server.relays.shared_reads import SharedReads, is_shared

if TYPE_CHECKING:
    from studio.protocol import Command
    from studio.protocol.listeners import Listener


class Page:
    def __init__(self, role: Role = Role.GUEST) -> None:
        self.role, self.person = role, "somebody"
        self.events: list[dict[str, Any]] = []

    def sees(self, document: str) -> bool:
        del document
        return True

    def post(self, data: bytes, *, binary: bool = False, key: str | None = None) -> None:
        del binary, key
        self.events.append(json.loads(data))


class AnOrigin:
    def __init__(self) -> None:
        self.asked = self.version = 0
        self.forgotten: list[Listener] = []
        self.answers = asyncio.Event()

    async def ask(self, command: Command, listener: Listener) -> None:
        self.asked += 1
        text = f"text {self.version}"
        await self.answers.wait()
        listener.post(b"bytes", binary=True)
        listener.post(json.dumps({"type": "you", "person": listener.person}).encode())
        listener.post(
            json.dumps({"type": "text", "request": command.request, "text": text}).encode()
        )
        listener.post(json.dumps({"type": "done", "request": command.request}).encode())

    def reads(self) -> SharedReads:
        return SharedReads(self.ask, self.forgotten.append, lambda: self.version)


def text(request: int, file: str = "a.xacro") -> GetText:
    return GetText(request=request, document="rover", file=file)


def test_pages_that_ask_the_same_at_once_get_their_own_answer_and_nothing_that_is_for_the_first():
    async def story() -> None:
        origin = AnOrigin()
        reads = origin.reads()
        pages = [Page() for _ in range(30)]
        asking = [
            asyncio.create_task(reads.answer(text(number), page))
            for number, page in enumerate(pages)
        ]
        await asyncio.sleep(0)
        origin.answers.set()
        await asyncio.gather(*asking)
        assert origin.asked == 1
        assert len(origin.forgotten) == 1
        for number, page in enumerate(pages):
            assert [(one["type"], one["request"]) for one in page.events] == [
                ("text", number),
                ("done", number),
            ]

    asyncio.run(story())


def test_a_page_that_was_told_of_a_change_is_not_answered_from_before_it():
    async def story() -> None:
        origin = AnOrigin()
        reads = origin.reads()
        early, late = Page(), Page()
        asking = asyncio.create_task(reads.answer(text(1), early))
        await asyncio.sleep(0)
        origin.version = 1
        later = asyncio.create_task(reads.answer(text(2), late))
        await asyncio.sleep(0)
        origin.answers.set()
        await asyncio.gather(asking, later)
        assert origin.asked == 2
        assert late.events[0]["text"] == "text 1"

    asyncio.run(story())


def test_other_questions_are_asked_by_themselves():
    async def story() -> None:
        origin = AnOrigin()
        origin.answers.set()
        reads = origin.reads()
        await reads.answer(text(1, "a.xacro"), Page())
        await reads.answer(text(2, "b.xacro"), Page())
        assert origin.asked == 2

    asyncio.run(story())


def test_that_the_origin_is_away_is_told_to_all_who_wait():
    async def story() -> None:
        async def ask(command: Command, listener: Listener) -> None:
            raise OriginAwayError

        reads = SharedReads(ask, lambda _: None, lambda: 0)
        found = await asyncio.gather(
            *(reads.answer(text(1), Page()) for _ in range(3)), return_exceptions=True
        )
        assert [type(one) for one in found] == [OriginAwayError] * 3

    asyncio.run(story())


@pytest.mark.parametrize("role", [Role.GUEST, Role.STUDENT])
def test_a_copy_and_a_helper_are_answered_for_themselves(role: Role):
    assert is_shared(text(1), Page(role))
    assert not is_shared(text(1), Page(Role.HELPER))
    assert not is_shared(text(1).model_copy(update={"document": "rover~somebody"}), Page(role))
