from __future__ import annotations

import pytest

from studio.packages.sources.python_file import PythonFile
from studio.packages.sources.topic_ends import topic_ends


@pytest.mark.parametrize(
    ("line", "end"),
    [
        ("create_publisher(T, '/chat', 10)", (True, "chat", True, False)),
        ("create_subscription(T, 'chat', f, qos)", (False, "chat", False, True)),
        ("create_subscription(T, 'chat', f, q.qos_profile_sensor_data)",
         (False, "chat", False, False)),
        ("create_publisher(T, topic='chat', qos_profile=depth)", None),
        ("create_publisher(T, name, 10)", None),
    ],
)  # fmt: skip
def test_topic_and_qos_are_read_where_they_are_written_out(
    line: str, end: tuple[bool, str, bool, bool] | None
):
    qos = "QoSProfile(depth=1, reliability=R.BEST_EFFORT, durability=D.TRANSIENT_LOCAL)"
    text = f"qos = {qos}\nself.{line}\n"
    found = [one[:4] for one in topic_ends(PythonFile("a.py", text.encode()))]
    assert found == ([end] if end else [])


def test_a_profile_that_is_assigned_twice_is_not_known():
    text = "q = QoSProfile(depth=1)\nq = QoSProfile(depth=2)\nn.create_publisher(T, 'chat', q)\n"
    assert list(topic_ends(PythonFile("a.py", text.encode()))) == []
