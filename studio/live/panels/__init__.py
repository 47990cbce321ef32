"""What panels see of a ROS 2 system, and do in it."""
