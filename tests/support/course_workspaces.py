"""A workspace for each seed of the course, made as a student makes it: packages, files, entries.

The commands are those that the course prints, run by `studio`; nodes are `listing`s. Nothing is
built.
"""

from __future__ import annotations

import contextlib
import shlex
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Final

from tests.support.command_line import studio
from tests.support.course_listings import listing

if TYPE_CHECKING:
    from collections.abc import Mapping

REPOSITORY: Final = Path(__file__).resolve().parents[2]
_NO_SCRIPTS: Final = "        'console_scripts': [\n"


@dataclass(frozen=True)
class Workspace:
    """A folder with `src`."""

    folder: Path

    @property
    def src(self) -> Path:
        return self.folder / "src"

    def create(self, line: str) -> None:
        """Run a line of `pkg create` as it is printed, less `ros2`."""
        self.src.mkdir(parents=True, exist_ok=True)
        with contextlib.chdir(self.src):
            ran = studio(*shlex.split(line))
        assert ran.code == 0, ran.err

    def write(self, path: str, text: str) -> Path:
        """Write a file of a package, `PACKAGE/...`."""
        file = self.src / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")
        return file

    def change(self, path: str, *edits: tuple[str, str]) -> None:
        """Replace words in a file; each must be there."""
        file = self.src / path
        text = file.read_text(encoding="utf-8")
        for old, new in edits:
            assert old in text, (path, old)
            text = text.replace(old, new, 1)
        file.write_text(text, encoding="utf-8")

    def add_nodes(
        self, package: str, nodes: Mapping[str, str], module: str = "", **names: str
    ) -> None:
        """Put listings into a Python package, and their entries into its setup.py.

        Args:
            package: Its name.
            nodes: By the name of the executable, the listing; its file has the listing's name.
            module: The Python package that they lie in; by default that of the same name.
            names: Other names of files, by listing.
        """
        inner = module or package
        entries = ""
        for executable, name in nodes.items():
            file = names.get(name, name)
            self.write(f"{package}/{inner}/{file}.py", listing(name))
            entries += f"            '{executable} = {inner}.{file}:main',\n"
        init = self.src / package / inner / "__init__.py"
        init.touch()
        self.change(f"{package}/setup.py", (_NO_SCRIPTS, _NO_SCRIPTS + entries))

    def add_interfaces(self, package: str, texts: Mapping[str, str], *depends: str) -> None:
        """Put definitions into a CMake package, with what makes rosidl generate them."""
        for path, text in texts.items():
            self.write(f"{package}/{path}", text)
        finds = "".join(f"find_package({name} REQUIRED)\n" for name in depends)
        files = "".join(f'  "{path}"\n' for path in texts)
        needs = f"  DEPENDENCIES {' '.join(depends)}\n" if depends else ""
        self.change(
            f"{package}/CMakeLists.txt",
            (
                "ament_package()",
                f"find_package(rosidl_default_generators REQUIRED)\n{finds}\n"
                f"rosidl_generate_interfaces(${{PROJECT_NAME}}\n{files}{needs})\n\n"
                "ament_package()",
            ),
        )
        tags = "".join(f"  <depend>{name}</depend>\n" for name in depends)
        self.change(
            f"{package}/package.xml",
            (
                "  <buildtool_depend>ament_cmake</buildtool_depend>\n",
                "  <buildtool_depend>ament_cmake</buildtool_depend>\n"
                "  <build_depend>rosidl_default_generators</build_depend>\n"
                f"{tags}"
                "  <exec_depend>rosidl_default_runtime</exec_depend>\n"
                "  <member_of_group>rosidl_interface_packages</member_of_group>\n",
            ),
        )


GET_NOW_PLAYING: Final = "---\nstring station_name\nstring song_title\nstring artist_name\n"
CHOOSE_SONG: Final = (
    "string song_name\n---\nbool success\nstring final_message\n---\n"
    "float32 progress_pct\nstring status_line\n"
)
ADD_TWO_INTS: Final = "int64 a\nint64 b\n---\nint64 sum\n"
QUOTE: Final = "int32 id\nstring quote\nstring philosopher_name\n"
ADD_POINTS: Final = (
    "geometry_msgs/Point a\ngeometry_msgs/Point b\n---\ngeometry_msgs/Point result\n"
)
JERRY_COMMAND: Final = "string direction\nint32 steps\n"
DISTANCE: Final = "float64 x\nfloat64 y\n---\nfloat64 distance\n"
TELEMETRY: Final = "string robot_name\nfloat64 battery_voltage\nint32 error_count\n"

DISPLAY_LAUNCH: Final = """\
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import Command, LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    model = PathJoinSubstitution([FindPackageShare('my_robot_description'), 'urdf',
                                  'my_robot.xacro'])
    description = ParameterValue(
        Command(['xacro ', model, ' wheel_radius:=', LaunchConfiguration('wheel_radius')]),
        value_type=str)
    return LaunchDescription([
        DeclareLaunchArgument('wheel_radius', default_value='0.2', description='in metres'),
        Node(package='robot_state_publisher', executable='robot_state_publisher',
             parameters=[{'robot_description': description}]),
        Node(package='joint_state_publisher', executable='joint_state_publisher'),
    ])
"""
"""The course only touches this file, and gives no text of it."""
ROBOT: Final = """\
<?xml version="1.0"?>
<robot xmlns:xacro="http://ros.org/wiki/xacro" name="xacro_robot">
  <xacro:arg name="wheel_radius" default="0.2"/>
  <xacro:property name="wheel_radius" value="$(arg wheel_radius)"/>
  <xacro:property name="wheel_thickness" value="0.05"/>
  <link name="base_link"/>
  <xacro:macro name="wheel" params="name x y">
    <link name="${name}_link">
      <visual>
        <geometry><cylinder radius="${wheel_radius}" length="${wheel_thickness}"/></geometry>
      </visual>
    </link>
    <joint name="${name}_joint" type="continuous">
      <parent link="base_link"/>
      <child link="${name}_link"/>
      <origin xyz="${x} ${y} 0"/>
      <axis xyz="0 1 0"/>
    </joint>
  </xacro:macro>
  <xacro:wheel name="front_left" x="1" y="1"/>
  <xacro:wheel name="front_right" x="1" y="-1"/>
  <xacro:wheel name="rear_left" x="-1" y="1"/>
  <xacro:wheel name="rear_right" x="-1" y="-1"/>
</robot>
"""


def radio_station(folder: Path) -> Workspace:
    """S0: a description, a radio station and its interfaces."""
    made = Workspace(folder)
    made.create("pkg create --build-type ament_cmake my_robot_description")
    made.write("my_robot_description/urdf/my_robot.xacro", ROBOT)
    made.write("my_robot_description/launch/robot_display.launch.py", DISPLAY_LAUNCH)
    made.change(
        "my_robot_description/CMakeLists.txt",
        (
            "ament_package()",
            "install(DIRECTORY urdf/ DESTINATION share/${PROJECT_NAME}/urdf)\n"
            "install(DIRECTORY launch/ DESTINATION share/${PROJECT_NAME}/launch)\nament_package()",
        ),
    )
    made.change(
        "my_robot_description/package.xml",
        (
            "  <buildtool_depend>ament_cmake</buildtool_depend>\n",
            "  <buildtool_depend>ament_cmake</buildtool_depend>\n"
            "  <exec_depend>xacro</exec_depend>\n"
            "  <exec_depend>robot_state_publisher</exec_depend>\n"
            "  <exec_depend>joint_state_publisher</exec_depend>\n",
        ),
    )
    made.create("pkg create --build-type ament_cmake radio_station_interfaces")
    made.add_interfaces(
        "radio_station_interfaces",
        {"srv/GetNowPlaying.srv": GET_NOW_PLAYING, "action/ChooseSong.action": CHOOSE_SONG},
    )
    made.create(
        "pkg create radio_station --build-type ament_python "
        "--dependencies rclpy radio_station_interfaces"
    )
    made.add_nodes(
        "radio_station",
        {
            "service_server": "get_now_playing_server",
            "service_client": "get_now_playing_client",
            "radio_dj": "action_server_node",
            "song_requester": "action_client_node",
        },
    )
    made.write("radio_station/launch/radio.launch.py", RADIO_LAUNCH)
    made.change(
        "radio_station/setup.py",
        (
            "        ('share/' + package_name, ['package.xml']),\n",
            "        ('share/' + package_name, ['package.xml']),\n"
            "        ('share/' + package_name + '/launch', ['launch/radio.launch.py']),\n",
        ),
    )
    return made


RADIO_LAUNCH: Final = """\
from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([
        Node(package='radio_station', executable='service_server', output='screen'),
        Node(package='radio_station', executable='radio_dj', namespace='late',
             name='night_dj', output='screen'),
    ])
"""


def quotes_and_jerry(folder: Path) -> Workspace:
    """S1: a first package, a library, quotes, points that are added, and Jerry."""
    made = Workspace(folder)
    made.create("pkg create py_pkg_node --build-type ament_python --dependencies rclpy")
    made.add_nodes(
        "py_pkg_node",
        {"print_forever_node": "print_forever", "sample_py_node": "basic_node"},
        print_forever="print_forever_node",
        basic_node="sample_py_node",
    )
    made.create("pkg create pkg_with_interfaces --build-type ament_cmake")
    made.add_interfaces(
        "pkg_with_interfaces",
        {
            "msg/AmazingQuote.msg": QUOTE,
            "msg/AmazingQuoteStamped.msg": f"std_msgs/Header header\n{QUOTE}",
            "msg/JerryCommand.msg": JERRY_COMMAND,
            "srv/AddPoints.srv": ADD_POINTS,
            "srv/Distance.srv": DISTANCE,
        },
        "geometry_msgs",
        "std_msgs",
    )
    made.create(
        "pkg create py_pkg_using_messages --build-type ament_python "
        "--dependencies rclpy pkg_with_interfaces"
    )
    made.add_nodes(
        "py_pkg_using_messages",
        {
            "amazing_quote_publisher_node": "quote_publisher",
            "amazing_quote_subscriber_node": "quote_subscriber",
            "add_points_service_server_node": "add_points_server",
            "add_points_service_client_node": "add_points_client",
            "command_publisher_node": "jerry_command_publisher",
            "jerry_robot_node": "jerry_robot",
            "client_node": "jerry_client",
        },
    )
    made.create("pkg create py_pkg_library --build-type ament_python --dependencies rclpy")
    inner = "py_pkg_library/py_pkg_library/sample_py_library"
    made.write(f"{inner}/__init__.py", "from ._sample_function import longest\n")
    made.write(
        f"{inner}/_sample_function.py",
        '"""Of some texts, the longest."""\n\n\ndef longest(texts):\n'
        "    return max(texts, key=len)\n",
    )
    made.write(
        "py_pkg_library/py_pkg_library/uses_library.py",
        "import rclpy\nfrom py_pkg_library.sample_py_library import longest\n"
        "from rclpy.node import Node\n\n\ndef main():\n    rclpy.init()\n"
        "    node = Node('uses_library')\n"
        "    node.get_logger().info(longest(['a', 'quote', 'it']))\n"
        "    rclpy.shutdown()\n",
    )
    made.change(
        "py_pkg_library/setup.py",
        (_NO_SCRIPTS, f"{_NO_SCRIPTS}            'uses = py_pkg_library.uses_library:main',\n"),
    )
    return made


def first_nodes(folder: Path) -> Workspace:
    """S2: first nodes, a number that is published, and a message of one's own."""
    made = Workspace(folder)
    made.create("pkg create my_py_pkg --build-type ament_python --dependencies rclpy")
    made.add_nodes(
        "my_py_pkg",
        {
            "test_node": "my_first_node",
            "my_tiny_node": "my_tiny_node",
            "my_tiny_pub": "my_tiny_pub",
            "my_tiny_sub": "my_tiny_sub",
        },
    )
    made.create("pkg create --build-type ament_cmake my_robot_interfaces")
    made.add_interfaces("my_robot_interfaces", {"msg/CustomTelemetry.msg": TELEMETRY})
    return made


DEMO_LAUNCH: Final = """\
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from ament_index_python.packages import get_package_share_directory


def generate_launch_description():
    path = get_package_share_directory('urdf_view') + '/r2d2.urdf.xml'
    with open(path) as file:
        text = file.read()
    sim_time = LaunchConfiguration('use_sim_time', default='false')
    return LaunchDescription([
        DeclareLaunchArgument('use_sim_time', default_value='false'),
        Node(package='robot_state_publisher', executable='robot_state_publisher',
             parameters=[{'use_sim_time': sim_time, 'robot_description': text}]),
        Node(package='urdf_view', executable='state_publisher', output='screen'),
    ])
"""


def chatter_and_r2d2(folder: Path, robot: str, launch: str = DEMO_LAUNCH) -> Workspace:
    """S3: hello, chatter, the adder, and R2D2 with its launch file.

    Args:
        folder: Of the workspace.
        robot: URDF of R2D2, which the course does not give.
        launch: Text of demo.launch.py.
    """
    made = Workspace(folder)
    made.create("pkg create --build-type ament_cmake c_pkg_name")
    made.create("pkg create --build-type ament_python python_pkg_name")
    made.add_nodes(
        "python_pkg_name",
        {
            "node_helloworld": "node_helloworld",
            "publisher_node": "publisher_node",
            "subscriber_node": "subscriber_node",
            "client": "client",
            "server": "server",
        },
        module="scripts",
    )
    made.create("pkg create learning_interface --build-type ament_cmake")
    made.add_interfaces("learning_interface", {"srv/AddTwoInts.srv": ADD_TWO_INTS})
    made.create(
        "pkg create urdf_view --build-type ament_python --dependencies rclpy --license Apache-2.0"
    )
    made.add_nodes("urdf_view", {"state_publisher": "state_publisher"})
    made.write("urdf_view/urdf/r2d2.urdf.xml", robot)
    made.write("urdf_view/launch/demo.launch.py", launch)
    made.change(
        "urdf_view/setup.py",
        (
            "from setuptools import find_packages, setup",
            "import os\nfrom glob import glob\n\nfrom setuptools import find_packages, setup",
        ),
        (
            "        ('share/' + package_name, ['package.xml']),\n",
            "        ('share/' + package_name, ['package.xml']),\n"
            "        (os.path.join('share', package_name, 'launch'),\n"
            "         glob(os.path.join('launch', '*launch.[pxy][yma]*'))),\n"
            "        (os.path.join('share', package_name), glob('urdf/*')),\n",
        ),
    )
    return made


def week_of_nodes(folder: Path) -> Workspace:
    """S4: a node of each kind."""
    made = Workspace(folder)
    made.create("pkg create --build-type ament_python my_robot_package")
    made.add_nodes(
        "my_robot_package",
        {
            "my_node": "my_node",
            "topic_publisher": "topic_publisher",
            "topic_subscriber": "topic_subscriber",
            "qos_topic_node": "qos_topic_node",
            "service_server": "service_server",
            "service_client": "service_client",
            "basic_node": "basic_node",
            "publisher_node": "publisher_of_4",
            "subscriber_node": "subscriber_of_4",
            "service_server_node": "service_server_node",
            "service_client_node": "service_client_node",
            "parameter_node": "parameter_node",
            "timer_node": "timer_node",
        },
    )
    made.create("pkg create --build-type ament_cmake my_cpp_package")
    made.create(
        "pkg create --build-type ament_python my_package "
        "--dependencies rclpy std_msgs sensor_msgs geometry_msgs"
    )
    made.add_nodes(
        "my_package",
        {
            "temperature_publisher": "temperature_publisher",
            "temperature_subscriber": "temperature_subscriber",
        },
    )
    return made
