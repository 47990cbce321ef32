"""The ROS system in the studio: its connection, topics, displays at work, calls, goals, parameters."""
