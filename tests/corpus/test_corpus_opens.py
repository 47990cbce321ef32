"""Every public robot that stock xacro expands opens in the studio and is drawn."""

from __future__ import annotations

import asyncio
import shutil
from typing import TYPE_CHECKING

import numpy as np
import pytest

from studio.description.evaluator.stock_xacro import export_urdf
from studio.packages.robot_files import robot_candidates
from studio.packages.roots import ServedRoots
from tests.support.descriptions import policy_for
from tests.support.open_documents import engine, opened
from tests.support.studio_page import changed_bytes
from tests.support.sweep import some_of

if TYPE_CHECKING:
    from pathlib import Path

    from studio.documents.document import Document

pytestmark = [pytest.mark.corpus, pytest.mark.timeout(300)]

NOT_DRAWN: dict[str, str] = {}
"""Entry files that stock expands and the studio does not draw, with the reason."""
ROBOTS_AT_LEAST = 60
_SHARES = 3
"""The corpus in this many parts, one for each core that is free."""


@pytest.fixture(scope="module")
def robots(corpus: Path) -> list[Path]:
    """Every entry file of the corpus that stock expands without arguments, with links in it."""
    policy = policy_for(corpus)
    found: list[Path] = []
    for entry in robot_candidates(corpus, ServedRoots([corpus])):
        if not entry.openable:
            continue
        try:
            text = export_urdf(str(entry.path), {}, policy)
        except Exception:  # noqa: BLE001 - stock refuses it, for whatever reason
            continue
        if "<link" in text:
            found.append(entry.path)
    return sorted(found)


def what_is_wrong(document: Document) -> str:
    """Why the robot does not count as drawn; empty when it does."""
    if document.last_run.phase != "ready":
        return f"is {document.last_run.phase}"
    model = document.model
    poses = model.kinematics.wxyz_xyz(model.joints.values)
    if not model.robot.links or not np.isfinite(poses).all():
        return "has no link that stands somewhere"
    if document.scene.missing_meshes():
        return f"waits for {document.scene.missing_meshes()}"
    if document.last_run.expansion and document.last_run.expansion.evaluator != "studio":
        return f"needs stock: {document.last_run.expansion.fallback_reason}"
    return ""


@pytest.mark.parametrize("share", some_of(range(_SHARES)))
def test_every_robot_that_stock_expands_is_drawn(
    share: int, robots: list[Path], corpus: Path, tmp_path: Path
):
    assert len(robots) > ROBOTS_AT_LEAST

    async def run() -> dict[str, str]:
        wrong: dict[str, str] = {}
        async with engine(tmp_path / "data", corpus) as made:
            for path in robots[share::_SHARES]:
                document, _ = await opened(made, path)
                if reason := what_is_wrong(document):
                    wrong[path.relative_to(corpus).as_posix()] = reason
                del made.documents[document.id]
                await document.close()
        return wrong

    wrong = asyncio.run(run())
    assert {path: why for path, why in wrong.items() if path not in NOT_DRAWN} == {}


def test_a_limit_and_a_length_of_ur10e_are_dragged_and_saved_byte_by_byte(
    corpus: Path, tmp_path: Path
):
    original = next(corpus.rglob("ur.urdf.xacro")).parents[1]
    copy = tmp_path / "ur_description"
    shutil.copytree(original, copy)
    for path in copy.rglob("*"):
        path.chmod(0o755 if path.is_dir() else 0o644)

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            path = copy / "urdf" / "ur.urdf.xacro"
            document, ear = await opened(made, path, ur_type="ur10e", name="ur")
            before = document.model.kinematics.wxyz_xyz(document.model.joints.values).copy()
            limit = ear.site("elbow_joint.max_velocity")
            length = ear.site("kinematics.forearm.x")
            await document.edits.edit_site(limit["id"], "90.0", "")
            await document.edits.edit_site(length["id"], "-0.7", "drag")
            assert not document.last_run.failed
            after = document.model.kinematics.wxyz_xyz(document.model.joints.values)
            assert np.abs(after - before).max() > 0.05
            await document.saving.save()

    asyncio.run(run())
    differing = [
        (path.name, changed_bytes(path, (copy / path.relative_to(original)).read_bytes()))
        for path in sorted(original.rglob("*"))
        if path.is_file() and path.read_bytes() != (copy / path.relative_to(original)).read_bytes()
    ]
    names = {name for name, _ in differing}
    assert names == {"default_kinematics.yaml", "joint_limits.yaml"}
    for _, lines in differing:
        ((old, new),) = lines
        assert old.split(b":")[0] == new.split(b":")[0]
        assert any(value in new for value in (b"-0.7", b"90.0"))
