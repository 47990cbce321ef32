"""Commands made from the schema, at random: none fails inside. `make sweep` sends many more."""

from __future__ import annotations

import asyncio
from random import Random
from typing import TYPE_CHECKING

import pytest

from studio.engine.messages import COMMANDS
from tests.support.command_fuzzer import CommandFuzzer
from tests.support.command_sweep import sweep

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
