"""Commands made from the schema, at random: none fails inside. `make sweep` sends many more."""

from __future__ import annotations

import asyncio
import time
from random import Random
from typing import TYPE_CHECKING

import pytest

from studio.server.commands import COMMAND_ADAPTER
from tests.support.command_fuzzer import CommandFuzzer
from tests.support.command_sweep import sweep
from tests.support.loop_watch import Stall, stalls

if TYPE_CHECKING:
    from pathlib import Path


@pytest.mark.parametrize("seed", [1, pytest.param(2, marks=pytest.mark.sweep)])
def test_no_random_command_fails_inside(seed: int, tmp_path: Path):
    swept = asyncio.run(sweep(tmp_path, seed, 160))
    assert swept.ends["done"] > 10
    assert not swept.failures


def test_the_fuzzer_makes_commands_of_every_kind_and_most_can_be_read():
    fuzzer = CommandFuzzer(Random(7), {})
    commands = [fuzzer.command(number) for number in range(4000)]
    assert len({one["type"] for one in commands}) == len(fuzzer.kinds)
    readable = 0
    for one in commands:
        try:
            COMMAND_ADAPTER.validate_python(one)
        except ValueError:
            continue
        readable += 1
    assert readable > 3000


def _work_in_python() -> None:
    end_s = time.thread_time() + 0.3
    while time.thread_time() < end_s:
        pass


def _work_in_c() -> None:
    """One call that lets nobody else at the interpreter."""
    sum(range(20_000_000))


def test_the_sweep_notices_work_on_the_loop_and_no_wait_for_the_processor():
    async def run() -> list[Stall]:
        noticed: list[Stall] = []
        with stalls(0.1, noticed.append):
            asyncio.get_running_loop().call_soon(time.sleep, 0.3)
            await asyncio.sleep(0)
            await asyncio.sleep(0)
            assert not noticed
            asyncio.get_running_loop().call_soon(_work_in_python)
            await asyncio.sleep(0)
            await asyncio.sleep(0)
        return noticed

    (stall,) = asyncio.run(run())
    assert stall.took_s >= 0.3
    assert "_work_in_python" in stall.what
    assert "while time.thread_time()" in str(stall)


def test_the_sweep_notices_a_thread_that_holds_the_interpreter():
    async def run() -> list[Stall]:
        noticed: list[Stall] = []
        with stalls(0.1, noticed.append):
            while not noticed:
                await asyncio.to_thread(_work_in_c)
        return noticed

    stall, *_ = asyncio.run(run())
    assert "held by the thread" in stall.what
