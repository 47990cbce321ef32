"""A recording in, its messages out on topics: what `ros2 bag play` is, and its services."""
