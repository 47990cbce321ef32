"""What launch files are written with: ROS's names, as launch files import them."""
