"""Recordings: bags of ROS 2 read by index, written and mended; the one room that imports mcap."""
