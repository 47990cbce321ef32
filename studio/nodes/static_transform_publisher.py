"""StaticTransformPublisher: publishes one fixed transform on /tf_static, latched.

Try: `studio run tf2_ros static_transform_publisher --z 0.5 --frame-id base --child-frame-id laser`,
then `studio topic echo /tf_static`.
"""

from __future__ import annotations

import argparse
import math
import sys
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, NoReturn

from studio.errors import ExternalShutdownException, RosArgumentError, StudioError
from studio.ros.client import Node, init, spin
from studio.ros.messages import message
from studio.ros.node.arguments import parse_arguments
from studio.tf.rotations import wxyz_from_rpy
from studio.tf2.broadcasters import StaticTransformBroadcaster

if TYPE_CHECKING:
    from collections.abc import Sequence

_QUATERNION: Final = ("qx", "qy", "qz", "qw")
_ANGLES: Final = ("roll", "pitch", "yaw")
_USAGE: Final = (
    "[--x X] [--y Y] [--z Z] [--yaw YAW] [--pitch PITCH] [--roll ROLL] "
    "[--qx QX] [--qy QY] [--qz QZ] [--qw QW] --frame-id FRAME --child-frame-id FRAME"
)


@dataclass(frozen=True, slots=True)
class Wanted:
    """A transform: metres, and a quaternion x, y, z, w."""

    xyz: tuple[float, float, float]
    xyzw: tuple[float, float, float, float]
    parent: str
    child: str


def read_wanted(arguments: Sequence[str]) -> Wanted:
    """Read the arguments of upstream's program, by options or in the old order.

    The old order is `x y z yaw pitch roll FRAME CHILD`, or `x y z qx qy qz qw FRAME CHILD`.

    Raises:
        RosArgumentError: They are none of these.
    """
    if len(arguments) in {8, 9} and not any(one.startswith("--") for one in arguments):
        return _positional(list(arguments))
    parser = _Parser(prog="static_transform_publisher", usage=_USAGE, add_help=False)
    for name in ("x", "y", "z"):
        parser.add_argument(f"--{name}", type=float, default=0.0)
    for name in (*_ANGLES, *_QUATERNION):
        parser.add_argument(f"--{name}", type=float)
    parser.add_argument("--frame-id", required=True)
    parser.add_argument("--child-frame-id", required=True)
    found = parser.parse_args(list(arguments))
    turned = [getattr(found, name) for name in _ANGLES]
    given = [getattr(found, name) for name in _QUATERNION]
    is_turned = any(one is not None for one in turned)
    is_quaternion = any(one is not None for one in given)
    if is_turned and is_quaternion:
        parser.error("give --roll, --pitch and --yaw, or a quaternion, not both")
    if is_quaternion:
        x, y, z = (one or 0.0 for one in given[:3])
        rotation = _unit((x, y, z, 1.0 if given[3] is None else given[3]))
    else:
        roll, pitch, yaw = (one or 0.0 for one in turned)
        rotation = _turned(roll, pitch, yaw)
    return _checked(Wanted((found.x, found.y, found.z), rotation, found.frame_id,
                           found.child_frame_id))  # fmt: skip


class _Parser(argparse.ArgumentParser):
    """Raises where argparse would end the process."""

    def error(self, message: str) -> NoReturn:
        raise RosArgumentError("static_transform_publisher", f"{message}; give {_USAGE}")


def _positional(arguments: list[str]) -> Wanted:
    *numbers, parent, child = arguments
    try:
        values = [float(one) for one in numbers]
    except ValueError:
        raise RosArgumentError(
            "static_transform_publisher", f"{' '.join(numbers)} are not all numbers; give {_USAGE}"
        ) from None
    x, y, z, *turned = values
    if len(turned) == 3:
        yaw, pitch, roll = turned
        rotation = _turned(roll, pitch, yaw)
    else:
        rotation = _unit((turned[0], turned[1], turned[2], turned[3]))
    return _checked(Wanted((x, y, z), rotation, parent, child))


def _turned(roll: float, pitch: float, yaw: float) -> tuple[float, float, float, float]:
    w, x, y, z = wxyz_from_rpy(roll, pitch, yaw)
    return x, y, z, w


def _unit(xyzw: tuple[float, float, float, float]) -> tuple[float, float, float, float]:
    length = math.hypot(*xyzw)
    if not length or not math.isfinite(length):
        raise RosArgumentError(
            "static_transform_publisher", f"the quaternion {xyzw} has no direction"
        )
    x, y, z, w = (one / length for one in xyzw)
    return x, y, z, w


def _checked(wanted: Wanted) -> Wanted:
    if not all(math.isfinite(one) for one in (*wanted.xyz, *wanted.xyzw)):
        raise RosArgumentError("static_transform_publisher", "a number is not finite")
    if wanted.parent.lstrip("/") == wanted.child.lstrip("/"):
        raise RosArgumentError(
            "static_transform_publisher", f"both frames are {wanted.child}: give two"
        )
    return wanted


class StaticTransformPublisher(Node):
    """Sends its transform once; it is kept for those who come later."""

    def __init__(self, wanted: Wanted) -> None:
        super().__init__("static_transform_publisher")
        self._broadcaster = StaticTransformBroadcaster(self)
        transform = message("geometry_msgs/msg/TransformStamped")()
        transform.header.stamp = self.get_clock().now().to_msg()
        transform.header.frame_id, transform.child_frame_id = wanted.parent, wanted.child
        part = transform.transform
        part.translation.x, part.translation.y, part.translation.z = wanted.xyz
        turned = part.rotation
        turned.x, turned.y, turned.z, turned.w = wanted.xyzw
        self._broadcaster.sendTransform(transform)
        x, y, z = wanted.xyz
        qx, qy, qz, qw = wanted.xyzw
        self.get_logger().info(
            "Spinning until stopped - publishing transform\n"
            f"translation: ('{x:.6f}', '{y:.6f}', '{z:.6f}')\n"
            f"rotation: ('{qx:.6f}', '{qy:.6f}', '{qz:.6f}', '{qw:.6f}')\n"
            f"from '{wanted.parent}' to '{wanted.child}'"
        )


def main(args: Sequence[str] | None = None) -> None:
    """Publish until a signal ends the process."""
    given = list(sys.argv[1:] if args is None else args)
    try:
        wanted = read_wanted(parse_arguments(given).rest)
        with init(args=given):
            spin(StaticTransformPublisher(wanted))
    except (KeyboardInterrupt, ExternalShutdownException):
        return
    except StudioError as error:
        raise SystemExit(str(error)) from None


if __name__ == "__main__":
    main()
