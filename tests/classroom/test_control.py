from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

from studio.classroom import control as module
from studio.classroom.control import Control

if TYPE_CHECKING:
    import pytest


def test_it_is_the_presenters_and_each_change_is_told_with_who_had_it():
    told: list[str] = []
    control = Control(told.append)
    assert control.holder == ""
    for person in ("ada", "ada", "bob", ""):
        control.give(person)
    assert told == ["", "ada", "bob"]


def test_it_returns_when_its_holder_stays_away_and_not_when_they_are_back(
    monkeypatch: pytest.MonkeyPatch,
):
    monkeypatch.setattr(module, "ABSENCE_S", 0.05)

    async def run() -> None:
        returned = asyncio.Event()
        control = Control(lambda before: returned.set() if before == "ada" else None)
        control.give("ada")
        control.left("ada")
        control.back("ada")
        control.left("bob")
        await asyncio.sleep(0.1)
        assert control.holder == "ada"
        control.left("ada")
        await asyncio.wait_for(returned.wait(), 60)
        assert control.holder == ""
        control.close()

    asyncio.run(run())


def test_it_is_five_seconds():
    assert module.ABSENCE_S == 5.0
