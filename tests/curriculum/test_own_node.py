"""The node that README shows: it runs as printed, beside those of the course."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import pytest

from tests.support.command_line import studio
from tests.support.demos import heard, node_at, running, running_demo
from tests.support.wire import running_router, wait_until

pytestmark = pytest.mark.network
README = Path(__file__).resolve().parents[2] / "README.md"


def test_the_node_of_the_readme_repeats_what_the_talker_says_and_ends_by_ctrl_c(tmp_path: Path):
    listings = re.findall(r"```python\n(.*?)```", README.read_text(encoding="utf-8"), re.DOTALL)
    (listing,) = (one for one in listings if "rclpy.spin(" in one)
    script = tmp_path / "shout.py"
    script.write_text(listing)
    with (
        running_router() as router,
        node_at(router) as node,
        running([sys.executable, "-P", "-m", "studio", "run", str(script)], router) as shout,
        running_demo(router, "talker"),
    ):
        loud = heard(node, "std_msgs/msg/String", "/loud")
        wait_until("something loud", lambda: bool(loud))
        assert loud[0].data == "HELLO WORLD"
        shout.wait_for("[shout]: I heard Hello World")
        shout.stop()
        assert "Traceback" not in shout.printed


COUNTING = """
import studio.ros.client as rclpy
from studio.ros.messages.own_interfaces.msg import Cell

try:
    with rclpy.init():
        node = rclpy.Node("counting")
        publisher = node.create_publisher(Cell, "cells", 10)
        node.create_timer(0.1, lambda: publisher.publish(Cell(voltage=1.5)))
        rclpy.spin(node)
except (KeyboardInterrupt, rclpy.ExternalShutdownException):
    pass
"""


def test_t11_a_node_of_ones_own_has_types_of_its_own_without_a_build(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    package = tmp_path / "own_interfaces" / "msg"
    package.mkdir(parents=True)
    (package / "Cell.msg").write_text("float32 voltage\n")
    script = tmp_path / "counting.py"
    script.write_text(COUNTING)
    monkeypatch.setenv("STUDIO_DATA_DIR", str(tmp_path / "data"))
    monkeypatch.setenv("STUDIO_INTERFACES", str(package.parent))
    with running_router() as router, running([sys.executable, str(script)], router):
        monkeypatch.delenv("STUDIO_INTERFACES")
        at = ("--connect", router)
        wait_until("the topic", lambda: "/cells" in studio("topic", "list", *at).out.split())
        ran = studio("topic", "echo", "/cells", "--once", *at)
    assert ran.out == "voltage: 1.5\n---\n", ran.err
