"""What a user's ROS 2 code imports: rclpy, tf2_ros, messages and the rest, by a finder put last.

Only a process that runs a user's program has the finder; nothing is installed under those names.
"""
