"""The ROS 2 system for panels: what they show of it, and do in it."""
