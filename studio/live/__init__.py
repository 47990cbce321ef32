"""The ROS system in the studio: its connection, topics, displays, calls, goals and parameters."""
