"""What a node that the page starts may have, with all that it starts."""

from __future__ import annotations

import asyncio
import os
import sys
from typing import TYPE_CHECKING

import pytest

from studio.live.programs.runs import Run, Wanted
from tests.support.greedy import CASES
from tests.support.wire import PATIENCE_S

if TYPE_CHECKING:
    from pathlib import Path

    from studio.launch.watchdog import Limits


@pytest.mark.parametrize(("code", "limits", "said"), CASES)
def test_a_node_that_takes_too_much_is_ended_with_a_sentence(
    tmp_path: Path, code: str, limits: Limits, said: str
):
    async def run() -> Run:
        command = (sys.executable, "-c", code)
        wanted = Wanted("node", "greedy.py", tmp_path, command, (), "greedy", executable="greedy")
        changed = asyncio.Event()
        ran = Run(wanted, 1, changed.set, limits)
        await ran.start(os.environ)
        async with asyncio.timeout(PATIENCE_S):
            while not ran.is_over:
                await changed.wait()
                changed.clear()
        await ran.close()
        return ran

    ran = asyncio.run(run())
    assert ran.view().trouble == f"the node is ended: {said}"
    assert ran.view().code != 0
