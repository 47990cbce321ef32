"""Rover: drives round a room and publishes all its sensors; /cmd_vel drives it.

Try: `studio demos rover`, then `studio topic list`, `studio topic hz /scan`, and
`studio topic pub -r 5 /cmd_vel geometry_msgs/msg/Twist "{linear: {x: 0.3}, angular: {z: 0.8}}"`;
five seconds after the last command it goes on by itself. `studio param set /rover autopilot false`
makes it wait.
"""

from __future__ import annotations


def main(args: list[str] | None = None) -> None:
    """Drive until stopped."""
    # Here, so that the room and the drive can be had without a node.
    from studio.course.rover.running import run  # noqa: PLC0415

    run(args)
