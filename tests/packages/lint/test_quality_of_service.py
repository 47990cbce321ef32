from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.packages.edits.new_files import node_text
from studio.packages.lint import checked
from studio.packages.sources.topic_ends import topic_ends
from tests.support.seeded_packages import codes, finding, sound, written

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from studio.packages.sources.python_file import PythonFile
    from studio.packages.sources.topic_ends import TopicEnd

IMPORT = (
    "from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy\n"
    "print(DurabilityPolicy, ReliabilityPolicy)\n"
)
BEST = "QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)"
LATCHED = "QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)"


@pytest.mark.parametrize(
    ("offered", "asked", "fits"),
    [(BEST, "10", False), ("10", LATCHED, False), (LATCHED, "10", True), ("10", BEST, True)],
)
def test_what_is_asked_must_be_offered(tmp_path: Path, offered: str, asked: str, *, fits: bool):
    package = sound(tmp_path)
    hear = node_text("hear", "subscriber").replace("self.hear, 10)", f"self.hear, {asked})")
    talk = node_text("talker", "publisher").replace("'chatter', 10)", f"'chatter', {offered})")
    written(package, "my_pkg/hear.py", hear.replace("import rclpy\n", f"import rclpy\n{IMPORT}"))
    written(package, "my_pkg/talker.py", talk.replace("import rclpy\n", f"import rclpy\n{IMPORT}"))
    if fits:
        assert codes(tmp_path) == set()
    else:
        assert "talker.py" in finding(tmp_path, "qos-mismatch", "hear.py").sentence


def test_the_files_of_a_workspace_are_read_once_for_all_its_packages(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    for number in range(4):
        package = sound(tmp_path, f"my_pkg_{number}")
        written(package, f"my_pkg_{number}/hear.py", node_text("hear", "subscriber"))
    read: list[str] = []

    def noted(python: PythonFile) -> Iterator[TopicEnd]:
        read.append(python.source.file)
        return topic_ends(python)

    monkeypatch.setattr(checked, "topic_ends", noted)
    assert codes(tmp_path) == set()
    assert len(read) == len(set(read)) > 4
