from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.support.command_line import studio
from tests.support.written_bags import KINDS, some_messages, write

if TYPE_CHECKING:
    from pathlib import Path


@pytest.fixture
def bag(tmp_path: Path) -> Path:
    write(tmp_path / "bag1", some_messages())
    return tmp_path / "bag1"


def test_a_bag_is_told_in_the_words_of_ros2(bag: Path):
    ran = studio("bag", "info", str(bag))
    assert ran.code == 0, ran.err
    empty, *lines = ran.out.splitlines()
    told = some_messages()
    begin_ns, end_ns = told[0][1], max(at_ns for _, at_ns, _ in told)
    assert empty == ""
    assert lines[0] == "Files:             bag1_0.mcap"
    assert lines[1].startswith("Bag size:          ")
    assert lines[2:4] == ["Storage id:        mcap", "ROS Distro:        jazzy"]
    span_ns = end_ns - begin_ns
    assert lines[4] == f"Duration:          {span_ns // 10**9}.{span_ns % 10**9:09}s"
    assert f"({begin_ns // 10**9}.{begin_ns % 10**9:09})" in lines[5]
    assert lines[7] == f"Messages:          {len(told)}"
    topics = sorted(KINDS)
    rows = lines[8 : 8 + len(topics)]
    assert [one.removeprefix("Topic information:").strip() for one in rows] == [
        f"Topic: {name} | Type: {KINDS[name]} | "
        f"Count: {sum(topic == name for topic, _, _ in told)} | Serialization Format: cdr"
        for name in topics
    ]
    assert lines[8].startswith("Topic information: Topic: /")
    assert ran.err.startswith('WARNING: /strange: The type "nobody_msgs/msg/Foo" cannot be used')
    assert lines[-2:] == ["Service:           0", "Service information: "]


def test_names_alone_and_the_order_of_topics(bag: Path):
    told = some_messages()
    counts = {name: sum(topic == name for topic, _, _ in told) for name in KINDS}
    ran = studio("bag", "info", str(bag), "-t", "--sort", "count")
    assert ran.out.splitlines() == sorted(KINDS, key=lambda name: (-counts[name], name))


def test_what_is_damaged_is_told_beside_what_is_whole(bag: Path):
    (file,) = bag.glob("*.mcap")
    file.write_bytes(file.read_bytes()[: file.stat().st_size * 3 // 4])
    ran = studio("bag", "info", str(bag))
    assert ran.code == 0
    assert "WARNING: bag1_0.mcap: " in ran.err
    (count,) = [one for one in ran.out.splitlines() if one.startswith("Messages:")]
    assert 0 < int(count.split()[1]) < len(some_messages())


def test_what_is_no_bag_is_told(tmp_path: Path):
    ran = studio("bag", "info", str(tmp_path))
    assert ran.code == 2
    assert "it holds no file of a bag" in ran.err
