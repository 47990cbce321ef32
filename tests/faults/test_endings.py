"""Ctrl-C and SIGTERM at any moment: a node ends within the two seconds that `stop` gives it."""

from __future__ import annotations

import signal
import sys
import time
from contextlib import ExitStack

import pytest

from tests.support.demos import running, running_demo
from tests.support.wire import running_router

pytestmark = pytest.mark.network
SIGNALS = [signal.SIGINT, signal.SIGTERM]
MORE_MOMENTS_S = [0.1, 0.6, 0.8, 1.0, 1.5]


@pytest.mark.parametrize("number", SIGNALS)
@pytest.mark.parametrize(
    ("name", "working"),
    [("talker", "Hello World"), ("listener", "Hello World"), ("radio_dj", "")],
)
def test_a_node_at_work_ends(endpoint: str, name: str, working: str, number: signal.Signals):
    with running_demo(endpoint, "talker") as talker, running_demo(endpoint, name) as demo:
        talker.wait_for("Hello World")
        demo.wait_for(working)
        demo.stop(number)
    assert "Traceback" not in demo.printed


@pytest.mark.parametrize("number", SIGNALS)
@pytest.mark.parametrize(
    "after_s",
    [0.0, 0.2, 0.4, *(pytest.param(one, marks=pytest.mark.sweep) for one in MORE_MOMENTS_S)],
)
def test_a_node_that_is_starting_ends(endpoint: str, after_s: float, number: signal.Signals):
    with running_demo(endpoint, "talker", warm=False) as demo:
        time.sleep(after_s)  # any moment is meant: there is no condition to wait for
        demo.stop(number)


@pytest.mark.parametrize("number", SIGNALS)
def test_a_node_whose_router_is_gone_ends(number: signal.Signals):
    with ExitStack() as stack:
        with running_router() as endpoint:
            talker = stack.enter_context(running_demo(endpoint, "talker"))
            talker.wait_for("Hello World")
        talker.stop(number)


@pytest.mark.parametrize("number", SIGNALS)
def test_a_node_that_waits_for_a_service_ends(endpoint: str, number: signal.Signals):
    code = (
        "import studio.ros.client as rclpy\n"
        "rclpy.init()\n"
        "node = rclpy.create_node('waiting')\n"
        "client = node.create_client(rclpy.service('std_srvs/srv/Trigger'), '/never')\n"
        "print('waits', flush=True)\n"
        "client.wait_for_service()\n"
    )
    with running([sys.executable, "-c", code], endpoint) as process:
        process.wait_for("waits")
        process.stop(number)
