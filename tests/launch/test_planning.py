from __future__ import annotations

import os
import subprocess
import tempfile
import time
from typing import TYPE_CHECKING

import pytest

from studio.launch.planning import PlanLimits, plan_launch_file
from tests.support.launch_files import index_of, planned
from tests.support.wire import wait_until

if TYPE_CHECKING:
    from pathlib import Path

    from studio.launch.plan import Plan

_FUNCTION = "def generate_launch_description():\n"
_LIMITS = PlanLimits(seconds=60.0, memory_bytes=600 << 20)


def _ended(folder: Path, text: str, name: str = "a.launch.py") -> Plan:
    file = folder / name
    file.write_text(text, encoding="utf-8")
    return plan_launch_file(file, {}, index_of(folder), _LIMITS)


def _sentences(plan: Plan) -> str:
    return " | ".join(one.sentence for one in plan.failures)


def test_an_endless_loop_ends_with_a_sentence_in_its_time(tmp_path: Path):
    began_s = time.monotonic()
    plan = plan_launch_file(
        _written(tmp_path, f"{_FUNCTION}    while True:\n        pass\n"),
        {},
        index_of(tmp_path),
        PlanLimits(seconds=1.0),
    )
    assert "is not planned whole: it takes longer than 1 s" in _sentences(plan)
    assert time.monotonic() - began_s < 20.0


def _written(folder: Path, text: str) -> Path:
    file = folder / "a.launch.py"
    file.write_text(text)
    return file


@pytest.mark.parametrize(
    ("body", "sentence"),
    [
        ("    x = []\n    while True:\n        x.append(bytearray(10_000_000))\n", "more memory"),
        ("    import os\n    while True:\n        os.fork()\n", "more than 24 processes"),
        (
            "    x = [open('/dev/null') for _ in range(900)]\n    import os\n"
            "    if os.fork() or True:\n        __import__('time').sleep(60)\n",
            "more than 1000 files open",
        ),
        (
            "    with open(__file__ + '.big', 'w') as file:\n        while True:\n"
            "            file.write('x' * 1_000_000)\n",
            "File too large",
        ),
        ("    return f()\ndef f():\n    return f()\n", "calls itself without end"),
        ("    open('/dev/zero').read()\n", "more memory"),
        ("    raise SystemExit(3)\n", "ends the process by itself"),
        ("    __import__('os')._exit(0)\n", "ended without an answer"),
    ],
)
def test_a_bomb_ends_with_a_sentence(tmp_path: Path, body: str, sentence: str):
    assert sentence in _sentences(_ended(tmp_path, _FUNCTION + body))


def test_nothing_that_a_launch_file_starts_outlives_its_plan(tmp_path: Path):
    mark = f"86{os.getpid()}"
    text = (
        f"import subprocess\n{_FUNCTION}"
        f"    subprocess.Popen(['setsid', 'sleep', '{mark}'])\n"
        f"    subprocess.Popen(['sh', '-c', 'setsid sleep {mark} & exit'])\n"
        "    from launch import LaunchDescription\n    return LaunchDescription([])\n"
    )
    assert _ended(tmp_path, text).failures == ()
    wait_until("its children gone", lambda: not _runs(f"sleep {mark}"))


def test_a_launch_file_that_ends_its_process_leaves_nothing_behind(tmp_path: Path):
    mark = f"87{os.getpid()}"
    text = (
        "import os, subprocess\n"
        f"subprocess.Popen(['/bin/sleep', '{mark}'], env={{}}, start_new_session=True)\n"
        "os._exit(0)\n"
    )
    assert "ended without an answer" in _sentences(_ended(tmp_path, text))
    assert not _runs(f"sleep {mark}")


def _runs(command: str) -> bool:
    found = subprocess.run(["pgrep", "-f", command], capture_output=True, check=False)
    return found.returncode == 0


def test_a_huge_package_xml_is_not_read_into_memory(tmp_path: Path):
    manifest = tmp_path / "package.xml"
    manifest.touch()
    os.truncate(manifest, 1 << 40)  # sparse: it takes no room on the disk
    text = f"from launch import LaunchDescription\n{_FUNCTION}    return LaunchDescription([])\n"
    plan = _ended(tmp_path, text)
    assert (plan.package, plan.failures) == ("", ())


def test_a_plan_leaves_no_files_and_names_the_users_own(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    temporary = tmp_path / "temporary"
    temporary.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(temporary))
    parameters = tmp_path / "p.yaml"
    parameters.write_text("/**:\n  ros__parameters:\n    who: $(var who)\n")
    text = (
        "import os, tempfile\nfrom launch import LaunchDescription\n"
        "from launch.actions import DeclareLaunchArgument\n"
        "from launch_ros.actions import Node\nfrom launch_ros.descriptions import ParameterFile\n"
        f"{_FUNCTION}    tempfile.mkdtemp()\n"
        "    return LaunchDescription([DeclareLaunchArgument('who', default_value='me'),\n"
        "        Node(package='a', executable='b', parameters=[\n"
        f"            ParameterFile({str(parameters)!r}, allow_substs=True)])])\n"
    )
    (node,) = _ended(tmp_path, text).nodes
    assert node.files == (str(parameters),)
    assert [(p.name, p.value, p.file) for p in node.parameters] == [("who", "me", str(parameters))]
    assert list(temporary.iterdir()) == []


def test_ten_thousand_nodes_are_too_many(tmp_path: Path):
    text = (
        "from launch import LaunchDescription\nfrom launch_ros.actions import Node\n"
        f"{_FUNCTION}    return LaunchDescription([Node(package='a', executable='b')"
        " for _ in range(10_000)])\n"
    )
    plan = _ended(tmp_path, text)
    assert "it starts more than 2000 nodes" in _sentences(plan)
    assert len(plan.nodes) == 2000


def test_a_gigabyte_that_is_printed_is_dropped(tmp_path: Path):
    text = (
        "from launch import LaunchDescription\n"
        f"{_FUNCTION}    for _ in range(1024):\n        print('x' * 1_000_000)\n"
        "    return LaunchDescription([])\n"
    )
    plan = _ended(tmp_path, text)
    assert plan.failures == ()
    assert "prints more than" in plan.log[-1].text
    assert sum(len(one.text) for one in plan.log) < 100_000


@pytest.mark.parametrize(
    ("name", "text", "sentence"),
    [
        (
            "a.launch.xml",
            '<!DOCTYPE l [<!ENTITY a "aaaa"><!ENTITY b "&a;&a;">]>\n<launch>&b;</launch>',
            'declares the entity "a"',
        ),
        (
            "a.launch.yaml",
            "launch:\n- arg: {name: a, default: &a x}\n- arg: {name: b, default: [*a, *a]}\n",
            "refers to another part of it",
        ),
        ("a.launch.yaml", "launch:\n- " + "[" * 5_000, "is no YAML"),
        ("a.launch.xml", "<launch>" + "<group>" * 500, "levels"),
        ("a.launch.xml", "<robot/>", "launch is expected"),
        ("a.launch.py", "x" * (3 << 20), "larger than 2 MB"),
        (
            "a.launch.xml",
            '<launch><include file="$(filename)"/></launch>',
            "includes itself without end",
        ),
    ],
)
def test_bad_input_is_a_sentence(tmp_path: Path, name: str, text: str, sentence: str):
    assert sentence in _sentences(_ended(tmp_path, text, name))


@pytest.mark.parametrize(
    ("text", "line", "sentence"),
    [
        (
            f"{_FUNCTION}    return LaunchDescription([])\nfrom launch import LaunchDescription\n"
            "LaunchDescription.x\n",
            4,
            "LaunchDescription",
        ),
        (
            "x = LaunchDescription([])\nfrom launch import LaunchDescription\n",
            1,
            "LaunchDescription is used before it is imported, in line 2: move that line to the top",
        ),
        (
            f"{_FUNCTION}    return LaunchDescription([])\n",
            2,
            "add from launch import LaunchDescription at the top",
        ),
        (f"{_FUNCTION}    x = 1\n", 2, "returns nothing: end it with return LaunchDescription"),
        (f"{_FUNCTION}    return [1]\n", 2, "returns list: it must return a LaunchDescription"),
        ("x = 1\n", 0, "it has no function generate_launch_description()"),
        ("import rclpy\n", 0, "this is a node, not a launch file"),
        ("def f(:\n", 1, "it is no Python"),
        (
            "from launch import LaunchDescription\nfrom launch_ros.actions import Node\n"
            f"{_FUNCTION}    return LaunchDescription([Node(package='a', executable='b',\n"
            "        parameters={'a': 1})])\n",
            4,
            "parameters is dict: it must be a list",
        ),
        (
            "from launch import LaunchDescription\nfrom launch.actions import LogInfo\n"
            f"{_FUNCTION}    return LaunchDescription([LogInfo(msg=3)])\n",
            4,
            "write it as a text, in quotes",
        ),
        (
            "from ament_index_python.packages import get_package_share_directory\n"
            f"{_FUNCTION}    get_package_share_directory('nope')\n",
            3,
            "package 'nope' not found",
        ),
    ],
)
def test_a_beginners_mistake_is_a_sentence_with_its_line(
    tmp_path: Path, text: str, line: int, sentence: str
):
    plan = planned(tmp_path, text)
    assert sentence in _sentences(plan)
    assert plan.failures[0].where.line == line
