"""Commands made from the schema, at random: none fails inside. `make sweep` sends many more."""

from __future__ import annotations

import asyncio
import time
from random import Random
from typing import TYPE_CHECKING

import pytest

from studio.engine.messages import COMMANDS
from tests.support.command_fuzzer import CommandFuzzer
from tests.support.command_sweep import long_callbacks, sweep

if TYPE_CHECKING:
    from pathlib import Path


@pytest.mark.parametrize("seed", [1, 2])
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
            COMMANDS.validate_python(one)
        except ValueError:
            continue
        readable += 1
    assert readable > 3000


def test_the_sweep_notices_work_on_the_loop_and_no_wait_for_the_processor():
    def work() -> None:
        end_s = time.thread_time() + 0.2
        while time.thread_time() < end_s:
            pass

    async def run() -> list[float]:
        noticed: list[float] = []
        with long_callbacks(0.1, noticed.append):
            asyncio.get_running_loop().call_soon(time.sleep, 0.3)
            await asyncio.to_thread(work)
            assert not noticed
            asyncio.get_running_loop().call_soon(work)
            await asyncio.sleep(0)
            await asyncio.sleep(0)
        return noticed

    (took_s,) = asyncio.run(run())
    assert took_s >= 0.2
