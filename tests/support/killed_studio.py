"""A studio that is killed: `python -m tests.support.killed_studio WHEN DATA_FOLDER ROBOT`.

WHEN `saving`: it makes the width and the reach of the robot's two files larger and saves both, and
is killed when the first is written; `edited`: it is killed as soon as an edit is in its draft.
"""

from __future__ import annotations

import asyncio
import os
import signal
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from tests.support.open_documents import engine, opened, until

if TYPE_CHECKING:
    from studio.documents.document import Document
    from tests.support.open_documents import Ear

_RENAME = Path.replace


def _kill() -> None:
    os.kill(os.getpid(), signal.SIGKILL)


def _rename_or_die(self: Path, target: str | os.PathLike[str]) -> Path:
    """Rename the first file of the save; nobody comes to the second one."""
    if self.name.startswith(".tools.xacro."):
        _kill()
    return _RENAME(self, target)


async def _save(document: Document, ear: Ear) -> None:
    await document.edits.edit_site(ear.site("reach")["id"], "0.5", "")
    await document.edits.edit_site(ear.site("width")["id"], "0.2", "")
    drafts = Path(sys.argv[2]) / "drafts"
    await until(lambda: any(b"tools" in one.read_bytes() for one in drafts.glob("*.json")))
    Path.replace = _rename_or_die
    await document.saving.save()


async def _edit(document: Document, ear: Ear) -> None:
    drafts = Path(sys.argv[2]) / "drafts"
    running = asyncio.create_task(document.edits.edit_site(ear.site("reach")["id"], "0.5", ""))
    await until(lambda: any(drafts.glob("*.json")))
    _kill()
    await running


async def _run(when: str, data: Path, robot: Path) -> None:
    async with engine(data) as made:
        document, ear = await opened(made, robot)
        await (_save if when == "saving" else _edit)(document, ear)


if __name__ == "__main__":
    asyncio.run(_run(sys.argv[1], Path(sys.argv[2]), Path(sys.argv[3])))
