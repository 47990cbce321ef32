"""ROS 2 on the wire of rmw_zenoh: names, tokens, types and messages as bytes, and back."""
