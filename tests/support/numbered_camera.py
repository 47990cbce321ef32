"""A camera in a process of its own, whose pictures are numbered in their pixels.

`python -m tests.support.numbered_camera WIDTH HEIGHT RATE_HZ`: rgb8, evenly, until somebody ends
it. Three quarters of every row have the colour of the number, the last is green.
"""

from __future__ import annotations

import sys
import time
from typing import TYPE_CHECKING, Final

import numpy as np

import studio.ros.client as rclpy
from studio.ros.cdr import Codec
from studio.ros.messages import message

if TYPE_CHECKING:
    from numpy.typing import NDArray

TOPIC: Final = "/eye/image_raw"
GREEN: Final = (0, 200, 0)
_IMAGE: Final = message("sensor_msgs/msg/Image")


def color_of(number: int) -> tuple[int, int, int]:
    """Red and green count; blue proves that nobody else painted it."""
    return number & 255, number >> 8 & 255, 255 - (number & 255)


def main(width: int, height: int, rate_hz: float) -> None:
    """Publish at that rate; what the machine is too slow for is left out, and has no number."""
    with rclpy.init():
        node = rclpy.create_node("numbered_camera")
        out = node.create_publisher(_IMAGE, TOPIC, 1)
        cdr = _blank(width, height)
        pixels = np.frombuffer(cdr, dtype=np.uint8)[-height * width * 3 :].reshape(height, -1)
        row = np.zeros((width, 3), dtype=np.uint8)
        began_s, number = time.monotonic(), 0
        while True:
            pixels[:] = _painted(row, number)
            out.publish(cdr)
            number += 1
            time.sleep(max(0.0, began_s + number / rate_hz - time.monotonic()))


def _painted(row: NDArray[np.uint8], number: int) -> NDArray[np.uint8]:
    middle = len(row) * 3 // 4
    row[:middle], row[middle:] = color_of(number), GREEN
    return row.reshape(-1)


def _blank(width: int, height: int) -> bytearray:
    """A message whose pixels are its last bytes."""
    step = 3 * width
    image = _IMAGE(width=width, height=height, encoding="rgb8", step=step)
    image.data = np.zeros(height * step, dtype=np.uint8)
    return bytearray(Codec(_IMAGE).encode(image))


if __name__ == "__main__":
    main(int(sys.argv[1]), int(sys.argv[2]), float(sys.argv[3]))
