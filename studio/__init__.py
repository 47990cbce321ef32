"""Robot description studio: xacro, URDF and ROS 2 in the browser, without a ROS install.

The rooms, each importing only rooms below it: cli, web, engine, scene, robot, description,
hub and packages, problems, settings and workers, errors. This file imports nothing, so that a
worker process pays only for the room that it runs.
"""

__version__ = "0.1.0"
