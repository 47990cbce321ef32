"""Two students with nodes of their own: one publishes, and one is green."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Any

import pytest

from studio.classroom.nodes import nodes as nodes_module
from studio.documents.lessons import lesson_room as module
from studio.protocol.lessons import OpenLesson
from studio.protocol.student_nodes import GetNodeAccess, StartNodes
from studio.ros.messages import message
from tests.support.class_room import Page, Room, run
from tests.support.open_documents import until
from tests.support.student_nodes import STRING, OwnNode
from tests.support.wire import free_port

if TYPE_CHECKING:
    from pathlib import Path

LESSON = """# Publish

check: topic /temperature is of std_msgs/msg/String

## Often

check: topic /temperature comes at 10 Hz ± 50 %
"""


@pytest.fixture(autouse=True)
def look_often(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(module, "_LOOK_EVERY_S", 0.05)
    monkeypatch.setattr(nodes_module, "_PORTS", (free_port(),))


def steps(page: Page) -> list[dict[str, Any]]:
    """How the steps stand, as the page was told last; none before."""
    told = [one for one in page.events if one["type"] == "lesson_state"]
    return told[-1]["steps"] if told else []


def done(page: Page) -> list[bool]:
    return [step["done_s"] is not None for step in steps(page)]


def test_the_student_whose_node_publishes_is_green_and_the_other_is_not(tmp_path: Path):
    folder = tmp_path / "lessons" / "publish"
    folder.mkdir(parents=True)
    (folder / "lesson.md").write_text(LESSON, encoding="utf-8")

    async def work(room: Room) -> None:
        await room.ask(room.presenter, StartNodes())
        pages = ada, bob = await room.student("Ada"), await room.student("Bob")
        for page in pages:
            await room.ask(page, GetNodeAccess())
            await room.ask(page, OpenLesson(document=room.shared.id, lesson="publish"))
        node = await asyncio.to_thread(OwnNode, ada.last("node_access")["shell"], "ada_talks")
        node.node.create_timer(0.1, lambda: node.out.publish(message(STRING)(data="21")))
        try:
            await until(lambda: bool(steps(bob)))
            async with asyncio.timeout(60):
                while done(ada) != [True, True]:
                    await asyncio.to_thread(node.spin, 0.2)
            assert done(bob) == [False, False]
            codes = [check["code"] for step in steps(bob) for check in step["checks"]]
            assert codes == ["topic.none", "publishers.none"]
        finally:
            node.close()

    run(tmp_path, work, lesson_folders=(tmp_path / "lessons",))
