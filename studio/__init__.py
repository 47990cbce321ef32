"""Robot description studio: xacro, URDF and ROS 2 in the browser, without a ROS install.

A room imports only rooms below it; CONTRIBUTING.md lists them. This file imports nothing, so that a
worker process pays only for the room that it runs.
"""

__version__ = "0.1.0"
