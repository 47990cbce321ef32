"""Files that are written below folders are noticed, but for what builds make."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

from studio.live.programs.watching import FolderWatch

if TYPE_CHECKING:
    from pathlib import Path


def test_files_of_sources_are_noticed_and_what_builds_make_is_not(tmp_path: Path):
    async def run() -> None:
        seen: set[Path] = set()
        watch = FolderWatch(seen.update)
        ws = tmp_path / "build" / "ws"  # its own place may be called so
        for name in ("src", "build", "src/__pycache__"):
            (ws / name).mkdir(parents=True)
        watch.watch([ws])
        source = ws / "src/node.py"
        async with asyncio.timeout(60):
            while source not in seen:
                for number, name in enumerate(
                    ("build/x.py", "src/__pycache__/x.pyc", "src/node.py")
                ):
                    (ws / name).write_text(str(number))
                await asyncio.sleep(0.1)
        assert seen == {source}
        await watch.close()

    asyncio.run(run())
