"""A rover in a room: /cmd_vel in, and all that such a robot tells of itself out."""
