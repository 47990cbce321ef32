"""The engine's side of ROS 2: joins when asked, publishes a document's robot, follows another."""
