from __future__ import annotations

from studio.course.demos import CHAPTERS, DEMOS, LESSONS


def test_every_demo_stands_in_one_chapter():
    taught = [lesson.demo for chapter in CHAPTERS.values() for lesson in chapter]
    assert sorted(taught) == sorted(demo.name for demo in DEMOS)
    assert len(LESSONS) == len(taught)


def test_no_two_nodes_have_one_name():
    nodes = [lesson.node for lesson in LESSONS.values()]
    assert len(set(nodes)) == len(nodes)
    assert all(node.startswith("/") for node in nodes)
