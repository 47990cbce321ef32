"""The worker process: it answers, and when it cannot, a sentence does and the next one is fresh."""

from __future__ import annotations

import asyncio
import os
import signal
import sys
from typing import TYPE_CHECKING

import pytest

from studio.description.client import DescriptionWorker
from studio.description.origins.origin_values import PartOrigin, PartOriginQuery
from studio.description.values import (
    ArgumentsRequest,
    Edit,
    EditRequest,
    Expansion,
    Failure,
    NoReply,
    OpenRequest,
)
from studio.errors import WorkerDiedError
from tests.support.descriptions import policy_for, robot, write

if TYPE_CHECKING:
    from pathlib import Path

GOOD = robot('<link name="a${1+1}"/>')
ENDLESS = robot(
    '<xacro:macro name="twice" params="n"><xacro:if value="${n > 0}">'
    '<xacro:twice n="${n - 1}"/><xacro:twice n="${n - 1}"/></xacro:if></xacro:macro>'
    '<xacro:twice n="60"/>'
)
"""The process itself would stop it, too, but later than its parent here."""


def request(file: Path) -> OpenRequest:
    return OpenRequest(str(file), {}, policy_for(file.parent), {})


def test_a_robot_is_opened_and_edited_in_its_own_process(tmp_path: Path):
    file = write(tmp_path, {"a.xacro": GOOD})

    async def scenario() -> None:
        worker = DescriptionWorker()
        try:
            answer = await worker.open(request(file))
            assert isinstance(answer, Expansion)
            assert worker.pid not in {None, os.getpid()}
            start = GOOD.index("a$")
            answer = await worker.edit(EditRequest((Edit(str(file), start, start + 1, b"b"),)))
            assert isinstance(answer, Expansion)
            assert answer.part_order == ("link:b2",)
        finally:
            await worker.close()

    asyncio.run(scenario())


def test_an_expansion_that_hangs_is_ended_and_the_next_one_works(tmp_path: Path):
    good, endless = write(tmp_path, {"a.xacro": GOOD}), write(tmp_path, {"b.xacro": ENDLESS})

    async def scenario() -> None:
        worker = DescriptionWorker(timeout_s=0.3)
        try:
            assert isinstance(await worker.open(request(good)), Expansion)
            answer = await worker.open(request(endless))
            assert isinstance(answer, Failure)
            assert answer.problem.code == "worker-timeout"
            assert answer.problem.place is not None
            assert answer.problem.place.file == str(endless)
            assert answer.files == (str(endless),)
            assert worker.needs_reopen
            assert isinstance(await worker.open(request(good)), Expansion)
            assert not worker.needs_reopen
        finally:
            await worker.close()

    asyncio.run(scenario())


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no SIGKILL")
def test_a_process_that_dies_must_be_opened_again(tmp_path: Path):
    file = write(tmp_path, {"a.xacro": GOOD})

    async def scenario() -> None:
        worker = DescriptionWorker()
        try:
            assert isinstance(await worker.open(request(file)), Expansion)
            assert worker.pid is not None
            os.kill(worker.pid, signal.SIGKILL)
            answer = await worker.set_arguments(ArgumentsRequest({}))
            assert isinstance(answer, Failure)
            assert answer.problem.code == "worker-died"
            assert worker.needs_reopen
            assert isinstance(await worker.open(request(file)), Expansion)
        finally:
            await worker.close()

    asyncio.run(scenario())


def test_a_question_is_answered_behind_the_run_under_way(tmp_path: Path):
    file = write(tmp_path, {"a.xacro": GOOD})

    async def scenario() -> None:
        worker = DescriptionWorker()
        try:
            opening = asyncio.create_task(worker.open(request(file)))
            await asyncio.sleep(0)  # the run is asked for first
            reply = await worker.query(PartOriginQuery("link:a2"))
            assert isinstance(reply, PartOrigin)
            assert opening.done()
        finally:
            await worker.close()

    asyncio.run(scenario())


def test_whoever_asks_may_go_away_and_the_robot_stays_open(tmp_path: Path):
    file = write(tmp_path, {"a.xacro": GOOD})

    async def scenario() -> None:
        worker = DescriptionWorker()
        try:
            await worker.open(request(file))
            asker = asyncio.create_task(worker.query(PartOriginQuery("link:a2")))
            await asyncio.sleep(0)
            asker.cancel()
            await asyncio.gather(asker, return_exceptions=True)
            assert asker.cancelled()
            assert isinstance(await worker.edit(EditRequest(())), Expansion)
            assert not worker.needs_reopen
        finally:
            await worker.close()

    asyncio.run(scenario())


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no SIGKILL")
def test_a_question_to_a_dead_process_is_an_error_and_starts_no_other(tmp_path: Path):
    file = write(tmp_path, {"a.xacro": GOOD})

    async def scenario() -> None:
        worker = DescriptionWorker()
        try:
            await worker.open(request(file))
            assert worker.pid is not None
            os.kill(worker.pid, signal.SIGKILL)
            with pytest.raises(WorkerDiedError):
                await worker.query(PartOriginQuery("link:a2"))
            assert isinstance(await worker.query(PartOriginQuery("link:a2")), NoReply)
            assert worker.pid is None
            assert isinstance(await worker.open(request(file)), Expansion)
            assert isinstance(await worker.query(PartOriginQuery("link:a2")), PartOrigin)
        finally:
            await worker.close()

    asyncio.run(scenario())


def test_nothing_is_answered_before_a_robot_is_open():
    async def scenario() -> None:
        answer = await DescriptionWorker().edit(EditRequest(()))
        assert isinstance(answer, Failure)
        assert answer.problem.code == "no-session"

    asyncio.run(scenario())


@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
def test_the_process_stays_light(tmp_path: Path):
    file = write(tmp_path, {"a.xacro": GOOD})

    async def scenario() -> str:
        worker = DescriptionWorker()
        try:
            await worker.open(request(file))
            with open(f"/proc/{worker.pid}/maps", encoding="utf-8") as maps:  # noqa: ASYNC230, PTH123
                return maps.read()
        finally:
            await worker.close()

    loaded = asyncio.run(scenario())
    assert "msgspec" in loaded
    assert "numpy" not in loaded
