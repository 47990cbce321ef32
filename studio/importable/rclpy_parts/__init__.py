"""What rclpy has beside nodes and their parts, which are in `studio.ros`."""
