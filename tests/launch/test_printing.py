from __future__ import annotations

from typing import TYPE_CHECKING

from studio.launch.plan import (
    Plan,
    PlannedArgument,
    PlannedCondition,
    PlannedFailure,
    PlannedGap,
    PlannedHappening,
    PlannedInclude,
    PlannedLog,
    PlannedNode,
    PlannedParameter,
    PlannedProcess,
    PlannedRemap,
    PlannedRobot,
    PlannedSetting,
    PlannedStart,
    Where,
    plan_from_json,
    plan_to_json,
)
from studio.launch.printing import shown_arguments, shown_plan
from tests.support.launch_files import described

if TYPE_CHECKING:
    from pathlib import Path


_TALKER = PlannedNode(
    0,
    "node",
    "p",
    "talker",
    "t",
    "/ns",
    "/ns/t",
    (PlannedParameter("rate", 2, "p.yaml"), PlannedParameter("robot_description", robot=0)),
    remaps=(PlannedRemap("a", "/b"),),
    arguments=("-d", "x y"),
    respawn=True,
    respawn_delay_s=0.5,
    container="/c",
    condition=PlannedCondition("sim", None),
    start=PlannedStart("node", "p/talker.py"),
)
_PLAN = Plan(
    "a.launch.py",
    arguments=(
        PlannedArgument("sim", None, ("yes", "no")),
        PlannedArgument("rate", "1", value="2"),
    ),
    includes=(
        PlannedInclude(0, "b.launch.py", {"x": "1 2"}),
        PlannedInclude(1, "c.launch.py", parent=0, when="after 3 s", failed="it is missing"),
    ),
    settings=(PlannedSetting("A", "1"), PlannedSetting("B", None)),
    nodes=(_TALKER, PlannedNode(1, "node", "q", "gz", start=PlannedStart("none", "no physics"))),
    processes=(PlannedProcess(2, ("echo", "x"), start=PlannedStart("installed", "/bin/echo")),),
    happenings=(PlannedHappening("on_exit", "when t exits", ("Shutdown",)),),
    robots=(PlannedRobot("r.xacro", "xacro", {"lidar": "none"}),),
    log=(PlannedLog("hello"),),
    unsupported=(PlannedGap("Odd", "Odd is left out", Where("a.launch.py", 4)),),
    failures=(PlannedFailure("it fails", Where("a.launch.py", 5)),),
)


def test_arguments_are_printed_as_ros2_launch_prints_them():
    plan = Plan(
        "a.launch.py",
        arguments=(
            PlannedArgument("model", "rover.urdf", ("a", "b"), "Which\n  robot.", "rover.urdf"),
            PlannedArgument("model", "other", include=0),
            PlannedArgument("rate"),
            PlannedArgument("set_above", value="1", include=0),
        ),
    )
    assert shown_arguments(plan) == (
        "Arguments (pass arguments as '<name>:=<value>'):\n"
        "\n"
        "    'model':\n"
        "        Which robot. Valid choices are: ['a', 'b']\n"
        "        (default: 'rover.urdf')\n"
        "\n"
        "    'rate':\n"
        "        no description given\n"
        "        (no default: a value is needed)\n"
        "\n"
        "    'set_above':\n"
        "        no description given"
    )
    assert shown_arguments(Plan("a.launch.py")).endswith("\n\n  No arguments.")


def test_a_plan_is_printed_part_below_part():
    assert shown_plan(_PLAN).splitlines() == [
        "a.launch.py",
        "Arguments:",
        "  sim has no value  (one of yes, no)",
        "  rate := 2",
        "Includes:",
        "  b.launch.py x:='1 2'",
        "    c.launch.py  [after 3 s]  (not read)",
        "Environment:",
        "  A=1",
        "  B is unset",
        "Nodes:",
        "  /ns/t  p talker  [sim: depends on a missing argument]",
        "      starts p/talker.py",
        "      rate: 2  (p.yaml)",
        "      robot_description: r.xacro lidar:=none",
        "      a -> /b",
        "      arguments: -d 'x y'",
        "      is started again 0.5 s after its end",
        "      in the container /c",
        "  /?  q gz",
        "      not started: no physics",
        "Commands:",
        "  echo x",
        "      starts /bin/echo",
        "Later:",
        "  when t exits:",
        "      Shutdown",
        "Robots:",
        "  r.xacro lidar:=none",
        "Log:",
        "  hello",
        "Not supported:",
        "  a.launch.py:4: Odd is left out",
        "Wrong:",
        "  a.launch.py:5: it fails",
    ]


def test_an_empty_plan_is_its_file():
    assert shown_plan(Plan("a.launch.py")) == "a.launch.py"


def test_a_plan_shows_all_that_a_node_and_a_command_are_started_with(tmp_path: Path):
    plan = described(
        tmp_path,
        "Node(package='demo_nodes_py', executable='talker', prefix='nice -n 5', cwd='/tmp',\n"
        "     ros_arguments=['--log-level', 'debug'], arguments=['a b'],\n"
        "     additional_env={'WHO': 'me'}),\n"
        "ExecuteProcess(cmd=['echo', 'a'], cwd='/', additional_env={'A': 'b'}),",
    )
    text = shown_plan(plan_from_json(plan_to_json(plan)))
    for line in (
        "    arguments: 'a b'",
        "    ROS arguments: --log-level debug",
        "    prefix: nice -n 5",
        "    in the folder /tmp",
        "    with WHO=me",
        "    in the folder /",
        "    with A=b",
    ):
        assert f"\n  {line}" in text, text


def test_a_command_line_in_one_word_is_told_how_to_be_written(tmp_path: Path):
    (one,) = described(tmp_path, "ExecuteProcess(cmd=['echo hi']),").processes
    assert one.start.text == (
        "'echo hi' is one word of cmd, and so the name of a program: write ['echo', 'hi'], or "
        "shell=True"
    )
