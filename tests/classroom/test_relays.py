from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.classroom.relays import NoRelays
from studio.errors import CommandError
from studio.protocol.relays import AddRelay, RemoveRelay
from tests.support.class_room import Room, run

if TYPE_CHECKING:
    from pathlib import Path

LINE = "tls/one.example:8100#key"


def test_a_studio_without_relays_refuses_them_in_a_sentence_without_the_key(tmp_path: Path):
    async def refused(room: Room) -> None:
        for command in (AddRelay(line=LINE), RemoveRelay(endpoint="tls/one.example:8100")):
            with pytest.raises(CommandError) as refusal:
                await room.ask(room.presenter, command)
            assert "cannot use" in str(refusal.value)
            assert "key" not in str(refusal.value)

    run(tmp_path, refused)


def test_the_presenter_adds_and_removes_relays(tmp_path: Path):
    class Kept(NoRelays):
        """Those that were added."""

        def __init__(self) -> None:
            self.lines: list[str] = []

        async def add(self, line: str, /) -> None:
            self.lines.append(line)

        async def remove(self, endpoint: str, /) -> None:
            self.lines = [one for one in self.lines if not one.startswith(endpoint)]

    async def changed(room: Room) -> None:
        room.classroom.relays = kept = Kept()
        await room.ask(room.presenter, AddRelay(line=LINE))
        assert kept.lines == [LINE]
        await room.ask(room.presenter, RemoveRelay(endpoint="tls/one.example:8100"))
        assert kept.lines == []

    run(tmp_path, changed)
