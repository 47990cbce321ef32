"""Robots on DDS, as zenoh-bridge-ros2dds shows them on Zenoh, and how nodes here meet them."""
