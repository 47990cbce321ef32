from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.support.launch_files import planned

if TYPE_CHECKING:
    from pathlib import Path

    from studio.launch.plan import Plan

_FILE = """\
/**:
  ros__parameters:
    rate: 5
    use_sim_time: false
    deep: {rate: 7, plugin: old}
"""


def _plan(folder: Path, parameters: str, **given: str) -> Plan:
    (folder / "p.yaml").write_text(_FILE)
    text = (
        "import os\nfrom launch import LaunchDescription\n"
        "from launch.actions import DeclareLaunchArgument\n"
        "from launch.conditions import IfCondition\n"
        "from launch.substitutions import LaunchConfiguration\n"
        "from launch_ros.actions import Node\nfrom launch_ros.descriptions import ParameterFile\n"
        "from nav2_common.launch import ReplaceString, RewrittenYaml\n"
        "FILE = os.path.join(os.path.dirname(__file__), 'p.yaml')\n"
        "def generate_launch_description():\n"
        "    return LaunchDescription([DeclareLaunchArgument('sim', default_value='true'),\n"
        "        DeclareLaunchArgument('ns', default_value=''),\n"
        "        Node(package='a', executable='b', name='n', namespace=LaunchConfiguration('ns'),\n"
        f"             parameters=[{parameters}])])\n"
    )
    plan = planned(folder, text, **given)
    assert [one.sentence for one in plan.failures] == []
    return plan


def _values(plan: Plan) -> dict[str, object]:
    return {one.name: one.value for one in plan.nodes[0].parameters}


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (
            "param_rewrites={'use_sim_time': LaunchConfiguration('sim')}",
            {"rate": 5, "use_sim_time": True, "deep.rate": 7, "deep.plugin": "old"},
        ),
        (
            "param_rewrites={'rate': '2.5', '/**.ros__parameters.deep.rate': '3'}, "
            "convert_types=True",
            {"rate": 2.5, "use_sim_time": False, "deep.rate": 3, "deep.plugin": "old"},
        ),
        (
            "param_rewrites={'rate': '2', '/**.ros__parameters.added.one': 'x'}",
            {
                "rate": "2",
                "use_sim_time": False,
                "deep.rate": "2",
                "deep.plugin": "old",
                "added.one": "x",
            },
        ),
        (
            "param_rewrites={}, key_rewrites={'deep': 'shallow'}",
            {"rate": 5, "use_sim_time": False, "shallow.rate": 7, "shallow.plugin": "old"},
        ),
    ],
)
def test_a_file_of_parameters_is_rewritten(
    tmp_path: Path, arguments: str, expected: dict[str, object]
):
    plan = _plan(tmp_path, f"ParameterFile(RewrittenYaml(FILE, {arguments}), allow_substs=True)")
    assert _values(plan) == expected
    assert plan.unsupported == ()
    assert plan.nodes[0].files == (str(tmp_path / "p.yaml"),)


def test_a_root_key_puts_all_into_a_namespace(tmp_path: Path):
    parameters = "RewrittenYaml(FILE, {}, root_key=LaunchConfiguration('ns'))"
    (tmp_path / "a").mkdir()
    assert _values(_plan(tmp_path / "a", parameters, ns="robot"))["rate"] == 5


def test_words_of_a_file_are_replaced_where_the_condition_holds(tmp_path: Path):
    parameters = "ReplaceString(FILE, {'old': 'new'}, IfCondition(LaunchConfiguration('sim')))"
    assert _values(_plan(tmp_path, parameters))["deep.plugin"] == "new"
    assert _values(_plan(tmp_path, parameters, sim="false"))["deep.plugin"] == "old"
