from __future__ import annotations

from typing import TYPE_CHECKING

from tests.support.launch_files import described, index_of, package_at, plan_of, planned

if TYPE_CHECKING:
    from pathlib import Path

    from studio.launch.plan import Plan, PlannedNode

_TALKER = "package='demo_nodes_py', executable='talker'"
_URDF = '<robot name="r2d2"><link name="axis"/></robot>\n'


def _node(plan: Plan, name: str) -> PlannedNode:
    assert plan.failures == ()
    return next(one for one in plan.nodes if one.name == name)


def test_a_node_has_all_that_the_launch_file_gives_it(tmp_path: Path):
    plan = described(
        tmp_path,
        f"""
        DeclareLaunchArgument('rate', default_value='2.5', description='per second'),
        Node({_TALKER}, name='t', namespace='left', output='screen', respawn=True,
             respawn_delay=2.0, arguments=['--loud', LaunchConfiguration('rate')],
             parameters=[{{'rate': LaunchConfiguration('rate'), 'who': 'me',
                          'n': {{'m': [1, 2]}}}}],
             remappings=[('chatter', 'talk')]),
        """,
    )
    one = _node(plan, "t")
    assert (one.full_name, one.output, one.respawn, one.respawn_delay_s) == (
        "/left/t",
        "screen",
        True,
        2.0,
    )
    assert {p.name: p.value for p in one.parameters} == {"rate": 2.5, "who": "me", "n.m": [1, 2]}
    assert (one.remaps[0].source, one.remaps[0].target) == ("chatter", "talk")
    assert one.arguments == ("--loud", "2.5")
    assert one.start.kind == "studio"
    assert one.where.file.endswith("a.launch.py")
    assert one.where.line > 0
    (argument,) = plan.arguments
    assert (argument.default, argument.value, argument.description) == ("2.5", "2.5", "per second")


def test_an_argument_without_a_value_is_said_and_the_rest_is_planned(tmp_path: Path):
    plan = described(
        tmp_path,
        f"""
        DeclareLaunchArgument('ur_type', choices=['ur5', 'ur10']),
        Node({_TALKER}, name=LaunchConfiguration('ur_type'),
             condition=IfCondition(EqualsSubstitution(LaunchConfiguration('ur_type'), 'ur5'))),
        Node({_TALKER}, name='other'),
        """,
    )
    assert [one.name for one in plan.missing] == ["ur_type"]
    assert plan.missing[0].choices == ("ur5", "ur10")
    first, other = plan.nodes
    assert first.name == "$(var ur_type)"
    assert first.condition is not None
    assert first.condition.holds is None
    assert other.condition is None


def test_a_value_that_is_no_choice_is_a_sentence_with_the_line(tmp_path: Path):
    plan = described(
        tmp_path, "DeclareLaunchArgument('ur_type', choices=['ur5', 'ur10'])", ur_type="ur7", x="1"
    )
    assert plan.failures[0].sentence == "ur_type is 'ur7': it must be one of ur5, ur10"
    assert plan.failures[0].where.line > 0
    assert plan.unknown == ("x",)


def test_what_a_false_condition_keeps_from_running_is_shown_as_such(tmp_path: Path):
    plan = described(
        tmp_path,
        f"""
        DeclareLaunchArgument('gui', default_value='false'),
        GroupAction([PushRosNamespace('in'), Node({_TALKER}, name='a')],
                    condition=IfCondition(LaunchConfiguration('gui'))),
        Node({_TALKER}, name='b', condition=UnlessCondition(LaunchConfiguration('gui'))),
        """,
    )
    a, b = plan.nodes
    assert a.condition is not None
    assert (a.condition.text, a.condition.holds) == ("if $(var gui)", False)
    assert b.condition is not None
    assert b.condition.holds is True
    assert b.namespace == "/"


def test_a_group_keeps_its_namespace_remaps_and_parameters_to_itself(tmp_path: Path):
    plan = described(
        tmp_path,
        f"""
        GroupAction([PushRosNamespace('a'), PushRosNamespace('b'), SetRemap('x', 'y'),
                     SetParameter('use_sim_time', True), Node({_TALKER}, name='inner')]),
        Node({_TALKER}, name='outer', namespace='/abs'),
        """,
    )
    inner, outer = _node(plan, "inner"), _node(plan, "outer")
    assert inner.full_name == "/a/b/inner"
    assert inner.remaps[0].target == "y"
    assert inner.parameters[0].value is True
    assert (outer.full_name, outer.remaps, outer.parameters) == ("/abs/outer", (), ())


def test_an_include_is_planned_with_its_arguments_as_a_tree(tmp_path: Path):
    (tmp_path / "inner.launch.py").write_text(
        "from launch import LaunchDescription\n"
        "from launch.actions import DeclareLaunchArgument\n"
        "from launch.substitutions import LaunchConfiguration\n"
        "from launch_ros.actions import Node\n"
        "def generate_launch_description():\n"
        "    return LaunchDescription([DeclareLaunchArgument('n', default_value='0'),\n"
        f"        Node({_TALKER}, name=['t', LaunchConfiguration('n')])])\n"
    )
    plan = described(
        tmp_path,
        """
        IncludeLaunchDescription(PathJoinSubstitution([ThisLaunchFileDir(), 'inner.launch.py']),
                                 launch_arguments={'n': '7'}.items()),
        IncludeLaunchDescription(PythonLaunchDescriptionSource('/no/such.launch.py')),
        """,
    )
    first, second = plan.includes
    assert (first.file, first.arguments) == (str(tmp_path / "inner.launch.py"), {"n": "7"})
    assert plan.nodes[0].name == "t7"
    assert plan.nodes[0].include == first.id
    assert "/no is not there" in second.failed


def test_what_happens_later_is_planned_one_level_with_its_when(tmp_path: Path):
    plan = described(
        tmp_path,
        f"""
        a := Node({_TALKER}, name='a', on_exit=Shutdown()),
        RegisterEventHandler(OnProcessExit(target_action=a, on_exit=[
            Node({_TALKER}, name='b'), TimerAction(period=3.0, actions=[Node({_TALKER}, name='c')]),
        ])),
        RegisterEventHandler(OnProcessStart(target_action=a, on_start=lambda e, c: None)),
        """,
    )
    assert [(one.name, one.when) for one in plan.nodes] == [
        ("a", ""),
        ("b", "when a exits"),
        ("c", "when a exits, then after 3 s"),
    ]
    assert plan.happenings[0].does == ("end the launch (reason not given)",)
    assert plan.happenings[-1].does == ("a function decides then",)


def test_functions_of_the_launch_file_are_called(tmp_path: Path):
    plan = described(
        tmp_path,
        f"""
        DeclareLaunchArgument('robots', default_value='name: x; name: y'),
        OpaqueFunction(function=lambda context: [
            Node({_TALKER}, name=LaunchConfiguration('robots').perform(context)[6])]),
        ForLoop('robots', function=lambda name: [Node({_TALKER}, name=f'of_{{name}}')]),
        """,
    )
    assert [one.name for one in plan.nodes] == ["x", "of_x", "of_y"]


def test_a_robot_has_its_file_and_the_arguments_that_xacro_would_get(tmp_path: Path):
    rover = "PathJoinSubstitution([FindPackageShare('rover_description'), 'urdf', 'r.xacro'])"
    rsp = "package='robot_state_publisher', executable='robot_state_publisher'"
    plan = described(
        tmp_path,
        f"""
        DeclareLaunchArgument('k'),
        Node({rsp}, parameters=[{{'robot_description': ParameterValue(Command(
            [FindExecutable(name='xacro'), ' ', {rover}, ' wheels:=', '6', ' k:=',
             LaunchConfiguration('k'), ' e:=""']), value_type=str)}}]),
        """,
    )
    (robot,) = plan.robots
    assert robot.file.endswith("rover_description/urdf/r.xacro")
    assert (robot.kind, robot.mappings) == ("xacro", {"wheels": "6", "k": "$(var k)", "e": ""})
    assert plan.nodes[0].parameters[0].robot == 0
    assert robot.node == plan.nodes[0].id


def test_a_robot_that_python_reads_or_expands_itself_is_found(tmp_path: Path):
    (tmp_path / "r.urdf").write_text(_URDF)
    plan = planned(
        tmp_path,
        f"""
import os, xacro
from launch import LaunchDescription
from launch_ros.actions import Node
def generate_launch_description():
    with open({str(tmp_path / "r.urdf")!r}) as file:
        text = file.read()
    doc = xacro.process_file('/x/y.urdf.xacro', mappings={{'a': '1'}})
    rsp = dict(package='robot_state_publisher', executable='robot_state_publisher')
    return LaunchDescription([Node(**rsp, parameters=[{{'robot_description': text}}]),
        Node(**rsp, parameters=[{{'robot_description': doc.toprettyxml(indent='  ')}}])])
""",
    )
    assert plan.failures == ()
    found = {(one.file, one.kind): one.mappings for one in plan.robots}
    assert found == {
        (str(tmp_path / "r.urdf"), "urdf"): {},
        ("/x/y.urdf.xacro", "xacro"): {"a": "1"},
    }


def test_files_that_install_elsewhere_are_found_where_ros_would_look(tmp_path: Path):
    text = """
import os
from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch_ros.actions import Node
def generate_launch_description():
    urdf = os.path.join(get_package_share_directory('view'), 'r2d2.urdf.xml')
    with open(urdf) as file:
        text = file.read()
    return LaunchDescription([Node(package='robot_state_publisher',
        executable='robot_state_publisher', parameters=[{'robot_description': text}],
        arguments=[urdf])])
"""
    folder = package_at(
        tmp_path, "view", {"launch/demo.launch.py": text, "urdf/r2d2.urdf.xml": _URDF}
    )
    plan = plan_of(folder / "launch" / "demo.launch.py", index_of(tmp_path))
    assert plan.failures == ()
    assert plan.package == "view"
    assert plan.robots[0].file == str(folder / "urdf" / "r2d2.urdf.xml")
    assert plan.nodes[0].arguments == (str(folder / "urdf" / "r2d2.urdf.xml"),)


def test_a_file_of_parameters_gives_each_node_its_own(tmp_path: Path):
    (tmp_path / "p.yaml").write_text(
        "/**:\n  ros__parameters:\n    all: 1\n"
        "/*/t:\n  ros__parameters:\n    mine: [1.0, 2.0]\n"
        "other:\n  ros__parameters:\n    theirs: 2\n"
    )
    plan = described(
        tmp_path,
        f"""
        Node({_TALKER}, name='t', namespace='ns',
             parameters=[PathJoinSubstitution([ThisLaunchFileDir(), 'p.yaml']), {{'all': 3}}]),
        Node({_TALKER}, name='u', parameters=['/no/such.yaml']),
        """,
    )
    values = {one.name: one.value for one in plan.nodes[0].parameters}
    assert values == {"all": 3, "mine": [1.0, 2.0]}
    assert "/no/such.yaml cannot be read" in plan.failures[0].sentence
    assert plan.failures[0].where.line > 0


def test_a_name_that_nobody_knows_is_a_row_and_never_an_import_error(tmp_path: Path):
    plan = planned(
        tmp_path,
        f"""
from launch import LaunchDescription
from launch.actions import NoSuchAction
from launch_ros.actions import Node
from launch.no_such_module import Thing
from moveit_configs_utils import MoveItConfigsBuilder
import not_on_this_machine as other
def generate_launch_description():
    config = MoveItConfigsBuilder('panda').robot_description(file_path='x').to_moveit_configs()
    return LaunchDescription([NoSuchAction(x=1), Thing(), other.thing(),
        Node({_TALKER}, name='t', parameters=[config.to_dict(), config.robot_description])])
""",
    )
    assert plan.failures == ()
    assert [one.name for one in plan.nodes] == ["t"]
    rows = {(one.name, one.where.line) for one in plan.unsupported}
    assert ("launch.actions.NoSuchAction", 3) in rows
    assert ("moveit_configs_utils.MoveItConfigsBuilder", 6) in rows
    assert any(name.startswith("launch.no_such_module") for name, _ in rows)
    assert any(name.startswith("not_on_this_machine") for name, _ in rows)


def test_what_is_not_started_says_why(tmp_path: Path):
    plan = described(
        tmp_path,
        """
        Node(package='gazebo_ros', executable='spawn_entity.py'),
        Node(package='rviz2', executable='rviz2', arguments=['-d', '/x/y.rviz']),
        ComposableNodeContainer(name='c', namespace='', package='rclcpp_components',
            executable='component_container', composable_node_descriptions=[
                ComposableNode(package='image_proc', plugin='image_proc::Rectify', name='r')]),
        ExecuteProcess(cmd=['ros2', 'topic', 'list']),
        ExecuteProcess(cmd=['no_such_program_at_all']),
        """,
    )
    assert [one.start.kind for one in plan.nodes] == ["none", "page", "none", "none"]
    assert "no physics" in plan.nodes[0].start.text
    assert plan.nodes[3].container == "/c"
    assert [one.start.kind for one in plan.processes] == ["command", "none"]


def test_the_environment_and_log_lines_are_noted(tmp_path: Path):
    plan = described(
        tmp_path,
        """
        SetEnvironmentVariable('TURTLEBOT3_MODEL', 'burger'),
        LogInfo(msg=['model ', EnvironmentVariable('TURTLEBOT3_MODEL')]),
        """,
    )
    assert (plan.settings[0].name, plan.settings[0].value) == ("TURTLEBOT3_MODEL", "burger")
    assert plan.log[0].text == "model burger"


def test_the_index_of_ament_knows_packages_of_sources_as_their_build_would(tmp_path: Path):
    text = (
        "from ament_index_python import get_packages_with_prefixes, has_resource\n"
        "from ament_index_python.resources import get_resource, get_resources\n"
        "from launch import LaunchDescription\nfrom launch.actions import LogInfo\n"
        "def generate_launch_description():\n"
        "    prefix = has_resource('packages', 'mine')\n"
        "    found = [get_packages_with_prefixes()['mine'], get_resources('packages')['mine'],\n"
        "             get_resource('packages', 'mine')[1]]\n"
        "    return LaunchDescription([LogInfo(msg=str(found == [prefix] * 3)),\n"
        "        LogInfo(msg=str(has_resource('packages', 'other')))])\n"
    )
    folder = package_at(tmp_path / "src", "mine", {"launch/a.launch.py": text})
    plan = plan_of(folder / "launch" / "a.launch.py", index_of(tmp_path / "src"))
    assert plan.failures == ()
    assert [one.text for one in plan.log] == ["True", "False"]
