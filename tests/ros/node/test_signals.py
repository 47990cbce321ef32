"""Ctrl-C and SIGTERM at any moment: each program is a process of its own."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys

import pytest

from tests.support.patience import ended_within
from tests.support.warm_python import NODE, start_python
from tests.support.wire import free_endpoint

ENDS_WITHIN_S = 2.0
PREPARED = """
import sys, threading, time
import studio.ros.client as rclpy
from studio.ros.messages.std_srvs.srv import Trigger
from studio.ros.wire.settings import WireSettings

def ready():
    print("ready", flush=True)

def join():
    rclpy.init([], settings=WireSettings(connect=(sys.argv[1],)), router="off")
    return rclpy.create_node("signalled")

"""
MOMENTS = {
    "spinning": "node = join(); node.create_timer(0.0, ready); rclpy.spin(node)",
    "serving": """
node = join()
node.create_service(Trigger, "x", lambda asked, given: given)
ready()
rclpy.spin(node)
""",
    "sleeping": "join(); ready(); time.sleep(600)",
    "sleeping in a callback": """
node = join()
node.create_timer(0.0, lambda: (ready(), time.sleep(600)))
rclpy.spin(node)
""",
    "waiting for a service": """
client = join().create_client(Trigger, "nobody")
ready()
client.wait_for_service()
""",
    "waiting for a lock": """
join()
lock = threading.Lock()
lock.acquire()
ready()
lock.acquire()
""",
    "with threads": """
node = join()
node.create_timer(0.0, lambda: (ready(), time.sleep(600)))
executor = rclpy.MultiThreadedExecutor()
executor.add_node(node)
executor.spin()
""",
    "sleeping by a rate": """
node = join()
threading.Thread(target=rclpy.spin, args=(node,), daemon=True).start()
rate = node.create_rate(0.001)
ready()
rate.sleep()
""",
    "after the end": "join(); rclpy.shutdown(); ready(); time.sleep(600)",
}


def ended_by(number: int, program: str, endpoint: str, *, warm: bool = True) -> tuple[int, str]:
    """Run a program until it says that it is ready, signal it, and give its code and errors."""
    process = start_python(
        [sys.executable, "-c", PREPARED + program, endpoint],
        os.environ,
        stderr=subprocess.PIPE,
        imported=NODE if warm else (),
    )
    assert process.stdout is not None
    assert process.stderr is not None
    with process.stdout as printed, process.stderr as errors:
        assert printed.readline() == "ready\n"
        process.send_signal(number)
        try:
            code = ended_within(process, ENDS_WITHIN_S)
        finally:
            process.kill()
            process.wait()
        return code, errors.read()


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM], ids=lambda one: one.name)
@pytest.mark.parametrize("moment", MOMENTS)
def test_a_signal_ends_a_node_within_two_seconds(
    moment: str, number: signal.Signals, endpoint: str
):
    code, errors = ended_by(number, MOMENTS[moment], endpoint, warm=moment != "spinning")
    assert "Fatal" not in errors
    if number == signal.SIGINT:
        assert code == -signal.SIGINT
        assert "KeyboardInterrupt" in errors or "ExternalShutdown" in errors


def test_a_signal_that_came_just_before_a_wait_ends_the_wait(endpoint: str):
    # Taken by another thread, it interrupts the main one as little as one that came too early.
    program = """
import signal
def interrupt():
    time.sleep(0.2)
    signal.pthread_kill(threading.get_ident(), signal.SIGINT)
join()
lock = threading.Lock()
lock.acquire()
threading.Thread(target=interrupt, daemon=True).start()
ready()
lock.acquire()
"""
    code, errors = ended_by(0, program, endpoint)
    assert (code, "KeyboardInterrupt" in errors) == (-signal.SIGINT, True)


def test_a_listing_that_expects_ctrl_c_ends_cleanly(endpoint: str):
    program = """
node = join()
try:
    ready()
    rclpy.spin(node)
except KeyboardInterrupt:
    pass
finally:
    node.destroy_node()
    rclpy.shutdown()
"""
    assert ended_by(signal.SIGINT, program, endpoint) == (0, "")


def test_a_loop_that_asks_ok_ends_by_itself(endpoint: str):
    program = """
node = join()
ready()
try:
    while rclpy.ok():
        rclpy.spin_once(node, timeout_sec=0.01)
except rclpy.ExternalShutdownException:
    pass
"""
    assert ended_by(signal.SIGTERM, program, endpoint) == (0, "")


def test_what_catches_ctrl_c_may_take_its_time(endpoint: str):
    program = """
node = join()
try:
    ready()
    rclpy.spin(node)
except KeyboardInterrupt:
    time.sleep(1.5)
    print("saved", file=sys.stderr, flush=True)
"""
    assert ended_by(signal.SIGINT, program, endpoint) == (0, "saved\n")


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM], ids=lambda one: one.name)
def test_a_signal_ends_a_process_that_waits_for_a_silent_router(number: signal.Signals):
    # Listens and accepts nobody, so that opening a session waits in code that runs no handler.
    with socket.socket() as silent:
        silent.bind(("127.0.0.1", 0))
        silent.listen(5)
        endpoint = f"tcp/127.0.0.1:{silent.getsockname()[1]}"
        code, _ = ended_by(number, "ready(); join(); time.sleep(600)", endpoint)
    assert code != 0


def test_ctrl_c_ends_a_node_that_a_script_started_in_the_background(endpoint: str):
    program = "node = join(); ready(); rclpy.spin(node)"
    ignoring = "import signal; signal.signal(signal.SIGINT, signal.SIG_IGN)\n"
    _, errors = ended_by(signal.SIGINT, ignoring + program, endpoint)
    # Quiet when the signal came before the first wait, as in rclpy.
    assert errors == "" or "ExternalShutdownException" in errors


def test_no_router_ends_by_a_sentence_and_no_hang():
    done = subprocess.run(
        [sys.executable, "-c", PREPARED + "join()", free_endpoint()],
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
        env=os.environ,
    )
    assert done.returncode == 1
    assert "NoRouterError" in done.stderr
