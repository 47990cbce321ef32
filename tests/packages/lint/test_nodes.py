from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.packages.edits.new_files import NODE_TEMPLATES, node_text
from tests.support.seeded_packages import codes, finding, mended, sound, written

if TYPE_CHECKING:
    from pathlib import Path

NEEDS = ("rclpy", "std_msgs", "example_interfaces", "rcl_interfaces")


def seeded(folder: Path, template: str, before: str = "", after: str = "") -> Path:
    """A package with a node of a template, in which some words are others."""
    package = sound(folder, "my_pkg", "ament_python", *NEEDS)
    text = node_text("talker", template)  # pyright: ignore[reportArgumentType]
    assert before in text, text
    written(package, "my_pkg/talker.py", text.replace(before, after, 1) if before else text)
    return package


@pytest.mark.parametrize("template", NODE_TEMPLATES)
def test_our_own_nodes_have_no_fault(tmp_path: Path, template: str):
    seeded(tmp_path, template)
    assert codes(tmp_path) == set()


def test_a_class_that_hides_its_type_is_renamed(tmp_path: Path):
    # A listing of the course, S0:369
    package = seeded(tmp_path, "service_server")
    file = package / "my_pkg" / "talker.py"
    file.write_text(
        file.read_text()
        .replace("class Talker(", "class AddTwoInts(")
        .replace("Talker()", "AddTwoInts()")
    )
    mended(tmp_path, "class-hides-type", "talker.py", 9)
    assert codes(tmp_path) == set()


def test_a_file_without_main_gets_it(tmp_path: Path):
    # A listing of the course, S2:161
    package = seeded(tmp_path, "publisher")
    file = package / "my_pkg" / "talker.py"
    text = file.read_text()
    file.write_text(text[: text.index("\n\ndef main")])
    mended(tmp_path, "no-main", "talker.py")
    assert codes(tmp_path) == set()


def test_a_node_that_is_never_spun_is(tmp_path: Path):
    seeded(tmp_path, "publisher", "        rclpy.spin(node)\n", "        pass\n")
    mended(tmp_path, "never-spun", "talker.py")
    assert codes(tmp_path) == set()


def test_a_loop_without_end_where_the_node_is_made_is_told(tmp_path: Path):
    # A listing of the course, S3:138
    seeded(
        tmp_path,
        "publisher",
        "        self.count = 0\n",
        "        self.count = 0\n        while rclpy.ok():\n            self.publish_text()\n",
    )
    finding(tmp_path, "endless-loop", "talker.py", 17)


def test_a_loop_that_spins_the_node_itself_is_no_fault(tmp_path: Path):
    # A listing of the course, S3:341
    seeded(
        tmp_path,
        "publisher",
        "        self.count = 0\n",
        "        self.count = 0\n        while rclpy.ok():\n            rclpy.spin_once(self)\n",
    )
    assert codes(tmp_path) == set()


def test_callbacks_that_block_are_told(tmp_path: Path):
    seeded(
        tmp_path,
        "subscriber",
        "        self.get_logger",
        "        time.sleep(1)\n        self.get_logger",
    )
    finding(tmp_path, "sleep-in-callback", "talker.py", 17)
    file = tmp_path / "my_pkg" / "my_pkg" / "talker.py"
    file.write_text(
        file.read_text().replace(
            "time.sleep(1)", "rclpy.spin_until_future_complete(self, self.future)"
        )
    )
    finding(tmp_path, "spin-in-callback", "talker.py", 17)


def test_a_call_within_a_callback_waits_for_ever(tmp_path: Path):
    seeded(
        tmp_path,
        "service_server",
        "        self.get_logger().info(f'{",
        "        self.client = self.create_client(AddTwoInts, 'other')\n"
        "        self.client.call(request)\n        self.get_logger().info(f'{",
    )
    finding(tmp_path, "call-in-callback", "talker.py", 19)


def test_asyncio_sleep_becomes_time_sleep(tmp_path: Path):
    # A listing of the course, S0:636
    package = seeded(
        tmp_path,
        "action_server",
        "            time.sleep(0.5)",
        "            await asyncio.sleep(0.5)",
    )
    file = package / "my_pkg" / "talker.py"
    file.write_text(
        file.read_text()
        .replace("def execute", "async def execute")
        .replace("import time\n", "import asyncio\n")
    )
    mended(tmp_path, "asyncio-sleep", "talker.py")
    assert codes(tmp_path) == set()


def test_a_response_that_is_not_returned_is(tmp_path: Path):
    seeded(tmp_path, "service_server", "        return response\n", "")
    mended(tmp_path, "response-not-returned", "talker.py")
    assert codes(tmp_path) == set()


def test_a_result_that_is_not_returned_is(tmp_path: Path):
    # A listing of the course, S0:636
    package = seeded(
        tmp_path,
        "action_server",
        "        return Fibonacci.Result(sequence=feedback.sequence)\n\n\n",
        "\n\n",
    )
    file = package / "my_pkg" / "talker.py"
    file.write_text(
        file.read_text().replace(
            "                return Fibonacci.Result(sequence=feedback.sequence)\n",
            "                break\n",
        )
    )
    mended(tmp_path, "result-not-returned", "talker.py")
    assert codes(tmp_path) == set()


def test_a_goal_that_is_not_asked_about_or_never_succeeds_is_told(tmp_path: Path):
    # A listing of the course, S0:701
    package = seeded(
        tmp_path, "action_client", "if not goal_handle.accepted:", "if not goal_handle:"
    )
    finding(tmp_path, "goal-not-checked", "talker.py")
    text = (
        node_text("talker", "action_server")
        .replace("goal_handle.succeed()", "pass")
        .replace("goal_handle.canceled()", "pass")
    )
    written(package, "my_pkg/talker.py", text)
    finding(tmp_path, "goal-never-succeeds", "talker.py")


def test_use_sim_time_is_not_declared_again(tmp_path: Path):
    # A listing of the course, S4:541
    seeded(
        tmp_path,
        "parameters",
        "        self.declare_parameter('rate_hz', 1.0)\n",
        "        self.declare_parameter('rate_hz', 1.0)\n"
        "        self.declare_parameter('use_sim_time', True)\n",
    )
    mended(tmp_path, "use-sim-time-declared", "talker.py", 16)
    assert codes(tmp_path) == set()


def test_the_result_of_setting_parameters_is_a_message(tmp_path: Path):
    # A listing of the course, S4:554
    package = seeded(
        tmp_path, "parameters", "from rcl_interfaces.msg import", "from rclpy.node import"
    )
    mended(tmp_path, "set-parameters-result", "talker.py")
    text = node_text("talker", "parameters").replace(
        "from rcl_interfaces.msg import SetParametersResult\n", "import rclpy.node\n"
    )
    written(
        package,
        "my_pkg/talker.py",
        text.replace(
            "return SetParametersResult(successful=True)",
            "return rclpy.node.SetParametersResult(successful=True)",
        ),
    )
    mended(tmp_path, "set-parameters-result", "talker.py")
