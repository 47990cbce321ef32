"""tf2_ros over the studio's transform trees: broadcasters, a buffer and what fills it."""
