"""What the page's own kinematics are measured against, as a file that its tests read.

`python -m tests.support.link_poses` writes it anew.
"""

from __future__ import annotations

import asyncio
import io
import json
import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from studio.protocol.robot import GetFrames, GetMasses
from studio.protocol.roles import Role
from studio.robot.masses import total
from tests.support.asked import ask_document
from tests.support.open_documents import Ear, engine, opened
from tests.support.yourdfpy_poses import poses_by_yourdfpy

if TYPE_CHECKING:
    from studio.documents.document import Document
    from studio.protocol import Command

REPOSITORY = Path(__file__).resolve().parents[2]
FILE = REPOSITORY / "tests" / "support" / "link-poses.json"
MODEL = REPOSITORY / "models" / "rover_description" / "urdf" / "rover.urdf.xacro"
_SEED = 4
_JOINT = ("name", "type", "parent", "child", "axis")


async def link_poses(data_folder: Path) -> dict[str, Any]:
    """The rover with its joints somewhere: what the page is told, and what others make of it."""
    async with engine(data_folder) as made:
        document, ear = await opened(made, MODEL)
        positions = document.model.kinematics.random_positions(np.random.default_rng(_SEED))
        by_name = dict(zip(document.model.kinematics.movable, positions.tolist(), strict=True))
        told = ear.last("robot")
        return {
            "links": [{"name": link["name"]} for link in told["links"]],
            "joints": [{key: joint[key] for key in _JOINT} for joint in told["joints"]],
            "origins": (await _answer(document, GetFrames()))["origins"],
            "positions": by_name,
            "poses": await _poses(document, by_name),
            "masses": (await _answer(document, GetMasses()))["links"],
            "centre": total(
                document.model.robot, document.model.kinematics, positions
            ).centre_m.tolist(),
        }


async def _answer(document: Document, command: Command) -> dict[str, Any]:
    ear = Ear(Role.GUEST)
    await ask_document(document, command, ear)
    return ear.events[0]


async def _poses(document: Document, positions: dict[str, float]) -> dict[str, list[float]]:
    """Three rows of each link's pose, one after the other."""
    found = poses_by_yourdfpy(io.BytesIO((await document.urdf.text()).encode()), positions)
    assert found is not None
    return {link: pose[:3].ravel().tolist() for link, pose in found.items()}


def main() -> None:
    with tempfile.TemporaryDirectory() as folder:
        made = asyncio.run(link_poses(Path(folder)))
    FILE.write_text(json.dumps(made, separators=(",", ":")) + "\n", encoding="utf-8")
    sys.stdout.write(f"{FILE}\n")


if __name__ == "__main__":
    main()
