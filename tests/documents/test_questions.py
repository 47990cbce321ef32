"""Questions beside edits, by the order of what a real worker answers, at a real document."""

from __future__ import annotations

import asyncio
import sys
from typing import TYPE_CHECKING

import pytest

from studio.description.language.questions import CompletionQuery, Completions, OutlineQuery
from studio.description.origins.origin_values import PartOrigin, SiteEffectsQuery
from studio.description.values import NoReply
from studio.errors import SupersededError
from studio.protocol.edits import EditSite
from studio.protocol.origins import GetOrigin
from studio.protocol.roles import Role
from tests.support.asked import ask_document
from tests.support.descriptions import write
from tests.support.loop_story import ORIGIN, SOURCE, NotedWorker, loop_story
from tests.support.open_documents import Ear, engine, opened

if TYPE_CHECKING:
    from pathlib import Path


REST = "studio.documents.questions.REST_S"
LONG_REST_S = 2.0
"""On a busy machine the steps of a drag come so late that it would count as at rest."""
stops_processes = pytest.mark.skipif(sys.platform == "win32", reason="Windows has no SIGSTOP")


@stops_processes
def test_an_edit_overtakes_the_questions_that_wait(tmp_path: Path):
    async def run() -> None:
        worker = NotedWorker()
        async with loop_story(tmp_path, worker) as story:
            story.stop()
            begun = story.asked(ORIGIN)
            await story.until_asked()  # the next ones are not with the worker
            waiting = [story.asked(SiteEffectsQuery("?")), story.asked(OutlineQuery())]
            await asyncio.sleep(0)
            edits = [asyncio.ensure_future(story.edit(digit)) for digit in ("2", "3")]
            await asyncio.sleep(0)
            story.go_on()
            await asyncio.gather(begun, *waiting, *edits)
            assert worker.answered[:2] == ["PartOriginQuery", "edit"]
            assert sorted(worker.answered[-2:]) == ["OutlineQuery", "SiteEffectsQuery"]

    asyncio.run(run())


@stops_processes
def test_a_flood_of_one_viewer_costs_two_answers(tmp_path: Path):
    async def run() -> None:
        worker = NotedWorker()
        async with loop_story(tmp_path, worker) as story:
            story.stop()
            viewer = Ear(Role.GUEST)
            begun = story.asked(SiteEffectsQuery("0"), viewer)
            await story.until_asked()
            flood = [story.asked(SiteEffectsQuery(str(n)), viewer) for n in range(1, 65)]
            await asyncio.sleep(0)
            story.go_on()
            ends = await asyncio.gather(begun, *flood, return_exceptions=True)
            kinds = [type(end) for end in ends]
            assert kinds == [NoReply, *[SupersededError] * 63, NoReply]
            assert worker.answered == ["SiteEffectsQuery"] * 2

    asyncio.run(run())


def test_nothing_that_takes_long_is_answered_within_a_drag(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(REST, LONG_REST_S)

    async def run() -> None:
        worker = NotedWorker()
        async with loop_story(tmp_path, worker) as story:
            await story.drag("2")
            asking, completing = story.asked(ORIGIN), CompletionQuery(str(story.file), b"<", 1)
            for digit in ("3", "4", "5"):
                assert isinstance(await story.asked(completing), Completions)
                await story.drag(digit)
            assert worker.answered == ["edit", *["CompletionQuery", "edit"] * 3]
            assert isinstance(await asking, PartOrigin)
            assert worker.answered[7:] == ["PartOriginQuery"]

    asyncio.run(run())


def test_a_drag_whose_runs_take_longer_than_a_rest_is_no_rest(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(REST, 0.0)

    async def run() -> None:
        worker = NotedWorker()
        async with loop_story(tmp_path, worker) as story:
            dragging = asyncio.ensure_future(story.drag("2"))
            await asyncio.sleep(0)
            asking = story.asked(ORIGIN)
            await dragging
            await story.drag("3")
            assert isinstance(await asking, PartOrigin)
            assert worker.answered == ["edit", "edit", "PartOriginQuery"]

    asyncio.run(run())


@stops_processes
def test_a_drag_that_begins_behind_a_run_holds_what_was_asked_before(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(REST, LONG_REST_S)

    async def run() -> None:
        worker = NotedWorker()
        async with loop_story(tmp_path, worker) as story:
            story.stop()
            editing = asyncio.ensure_future(story.edit("2"))
            await story.until_asked()
            asking = story.asked(ORIGIN)
            await asyncio.sleep(0)
            dragging = asyncio.ensure_future(story.drag("3"))
            await asyncio.sleep(0)
            story.go_on()
            await asyncio.gather(editing, dragging)
            await story.asked(CompletionQuery(str(story.file), b"<", 1))
            await story.drag("4")
            await asking
            order = ["edit", "edit", "CompletionQuery", "edit", "PartOriginQuery"]
            assert worker.answered == order

    asyncio.run(run())


def test_between_edits_that_are_no_drag_questions_are_answered(tmp_path: Path):
    async def run() -> None:
        worker = NotedWorker()
        async with loop_story(tmp_path, worker) as story:
            asking = story.asked(ORIGIN)
            await story.edit("2")
            await asking
            await story.edit("3")
            assert worker.answered == ["edit", "PartOriginQuery", "edit"]

    asyncio.run(run())


def test_whoever_waits_for_an_answer_is_let_go_when_the_loop_is_closed(tmp_path: Path):
    async def run() -> None:
        worker = NotedWorker()
        async with loop_story(tmp_path, worker) as story:
            await story.drag("2")
            asking = story.asked(ORIGIN)
            await asyncio.sleep(0)
            await story.loop.close()
            await asyncio.wait({asking})
            assert asking.cancelled()

    asyncio.run(run())


def test_a_viewers_question_waits_until_the_presenters_drag_rests(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(REST, LONG_REST_S)
    file = write(tmp_path / "robot", {"a.urdf.xacro": SOURCE})

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, file)
            site, viewer = ear.site("m")["id"], Ear(Role.GUEST)

            async def drag(text: str) -> None:
                await ask_document(document, EditSite(site=site, text=text, gesture="g"), ear)

            await drag("2")
            asking = asyncio.ensure_future(
                ask_document(document, GetOrigin(part="link:left"), viewer)
            )
            for text in ("3", "4", "5"):
                await drag(text)
                assert viewer.events == []
            await asking
            (answer,) = viewer.events
            values = [one["value"] for one in answer["origin"]["attributes"]]
            assert "10" in values

    asyncio.run(run())
