"""The node that README shows: it runs as printed, beside those of the course."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import pytest

from tests.support.demos import heard, node_at, running, running_demo
from tests.support.wire import running_router, wait_until

pytestmark = [pytest.mark.network, pytest.mark.timeout(120)]
README = Path(__file__).resolve().parents[2] / "README.md"


def test_the_node_of_the_readme_repeats_what_the_talker_says_and_ends_by_ctrl_c(tmp_path: Path):
    (listing,) = re.findall(r"```python\n(.*?)```", README.read_text(encoding="utf-8"), re.DOTALL)
    script = tmp_path / "shout.py"
    script.write_text(listing)
    with (
        running_router() as router,
        node_at(router) as node,
        running([sys.executable, str(script)], router) as shout,
        running_demo(router, "talker"),
    ):
        loud = heard(node, "std_msgs/msg/String", "/loud")
        wait_until("something loud", lambda: bool(loud))
        assert loud[0].data == "HELLO WORLD"
        shout.wait_for("[shout]: I heard Hello World")
        shout.stop()
        assert "Traceback" not in shout.printed
