"""How long ten nodes of a launch file take to their first message, and their plan.

Asked for on a quiet machine: ten nodes in 2 s.
"""

from __future__ import annotations

import os
import resource
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from studio.ros.wire.endpoints import parse_endpoint
from studio.ros.wire.router import start_router
from tests.benchmarks.report import Timings, judge, note, say_beside
from tests.support.launch_files import index_of, package_at, plan_of
from tests.support.wire import free_endpoint

NODES = 10
RUNS = 5
GOAL_S = 2.0
_NODE = """\
import rclpy
from rclpy.node import Node
from std_msgs.msg import String

def main():
    rclpy.init()
    node = Node('node')
    node.create_publisher(String, 'chatter', 10).publish(String(data='first'))
    print('published', flush=True)
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
"""
_LAUNCH = """\
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

def generate_launch_description():
    return LaunchDescription([DeclareLaunchArgument('rate', default_value='1.0')] + [
        Node(package='ten', executable='one', name=f'n{number}', output='screen',
             parameters=[{'rate': LaunchConfiguration('rate')}]) for number in range(%d)])
"""


def start_s(src: Path, endpoint: str) -> tuple[float, float]:
    """Return the seconds to the last node's first message, and those of the processor in all."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    command = [sys.executable, "-P", "-m", "studio", "launch", "ten", "a.launch.py"]
    began_s = time.perf_counter()
    process = subprocess.Popen(
        [*command, "--package-path", str(src), "--connect", endpoint],
        stdout=subprocess.PIPE,
        text=True,
        env={**os.environ},
    )
    assert process.stdout is not None
    count, taken_s = 0, 0.0
    for line in process.stdout:
        count += "published" in line
        if count == NODES:
            taken_s = time.perf_counter() - began_s
            break
    process.send_signal(signal.SIGINT)
    process.stdout.read()
    process.stdout.close()
    process.wait()
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return taken_s, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def run() -> None:
    """Start it some times, and plan it as often."""
    started = Timings(f"{NODES} nodes to the last one's first message")
    used = Timings("time of the processor, with their end")
    planned = Timings("plan of their launch file")
    with tempfile.TemporaryDirectory() as folder:
        src = Path(folder) / "src"
        files = {"launch/a.launch.py": _LAUNCH % NODES, "ten/one.py": _NODE}
        package = package_at(src, "ten", files, "one")
        endpoint = free_endpoint()
        with start_router(parse_endpoint(endpoint)):
            for _ in range(RUNS):
                start, processor = start_s(src, endpoint)
                started.values_ms.append(start * 1000)
                used.values_ms.append(processor * 1000)
        index = index_of(src)
        for _ in range(RUNS):
            with planned.measure():
                plan_of(package / "launch" / "a.launch.py", index)
    say_beside("a launch file of nodes of one package, started by `studio launch`", started)
    median_s = started.median_ms / 1000
    judge(f"{NODES} nodes of a launch file", median_s, at_most=GOAL_S, unit="s")
    note(f"{NODES} nodes of a launch file, the fastest", f"{min(started.values_ms) / 1000:.2f} s")
    note(f"{NODES} nodes of a launch file, processor", f"{used.median_ms / 1000:.2f} s")
    note(f"plan of {NODES} nodes", f"{planned.median_ms / 1000:.2f} s")
