"""Show the astromech in RViz with joint sliders.

ros2 launch r2d2_description display.launch.py
"""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import Command, LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare

CHOICES = {
    "stands": ["true", "false"],
}


def generate_launch_description() -> LaunchDescription:
    """Declare the model's own arguments and start the three nodes."""
    share = FindPackageShare("r2d2_description")
    command = ["xacro ", PathJoinSubstitution([share, "urdf", "r2d2.urdf.xacro"])]
    for name in CHOICES:
        command += [f" {name}:=", LaunchConfiguration(name)]
    description = ParameterValue(Command(command), value_type=str)
    return LaunchDescription(
        [
            *(
                DeclareLaunchArgument(name, default_value=choices[0], choices=choices)
                for name, choices in CHOICES.items()
            ),
            Node(
                package="robot_state_publisher",
                executable="robot_state_publisher",
                parameters=[{"robot_description": description}],
            ),
            Node(
                package="joint_state_publisher_gui",
                executable="joint_state_publisher_gui",
            ),
            Node(
                package="rviz2",
                executable="rviz2",
                arguments=["-d", PathJoinSubstitution([share, "rviz", "r2d2.rviz"])],
            ),
        ]
    )
