"""A camera in a process of its own, whose pictures are numbered in their pixels.

`python -m tests.support.numbered_camera WIDTH HEIGHT RATE_HZ`: rgb8, evenly, until somebody ends
it. Three quarters of every row have the colour of the number, the last is green. It says how many
hear it, whenever that is news.
"""

from __future__ import annotations

import sys
import time
from contextlib import contextmanager
from typing import TYPE_CHECKING, Final

import numpy as np

import studio.ros.client as rclpy
from studio.ros.cdr import codec_of
from studio.ros.messages import message
from tests.support.demos import running

if TYPE_CHECKING:
    from collections.abc import Generator

    from numpy.typing import NDArray

    from tests.support.demos import RunningDemo

TOPIC: Final = "/eye/image_raw"
GREEN: Final = (0, 200, 0)
WATCH: Final = """() => {
  const canvas = document.querySelector(".image-frame canvas");
  const pixel = new OffscreenCanvas(1, 1).getContext("2d", { willReadFrequently: true });
  const colorAt = (share) => {
    pixel.drawImage(canvas, canvas.width * share, canvas.height / 2, 1, 1, 0, 0, 1, 1);
    return [...pixel.getImageData(0, 0, 1, 1).data];
  };
  window.seen = [];
  const look = () => {
    const [red, green, blue, alpha] = colorAt(0.1);
    const found = [red, green, blue, ...colorAt(0.9).slice(0, 3)];
    if (alpha > 0 && String(found) !== String(window.seen.at(-1))) window.seen.push(found);
    requestAnimationFrame(look);
  };
  look();
}"""
"""Notes the pixels of a number and of the green, each time that they are others."""
_IMAGE: Final = message("sensor_msgs/msg/Image")


def color_of(number: int) -> tuple[int, int, int]:
    """Red and green count; blue proves that nobody else painted it."""
    return number & 255, number >> 8 & 255, 255 - (number & 255)


@contextmanager
def numbered_camera(endpoint: str, size: tuple[int, int], rate_hz: float) -> Generator[RunningDemo]:
    """Have it at a router."""
    words = [sys.executable, "-m", __name__, *map(str, (*size, rate_hz))]
    with running(words, endpoint) as camera:
        yield camera


def main(width: int, height: int, rate_hz: float) -> None:
    """Publish at that rate; what the machine is too slow for is left out, and has no number."""
    with rclpy.init():
        node = rclpy.create_node("numbered_camera")
        out = node.create_publisher(_IMAGE, TOPIC, 1)
        cdr = _blank(width, height)
        pixels = np.frombuffer(cdr, dtype=np.uint8)[-height * width * 3 :].reshape(height, -1)
        row = np.zeros((width, 3), dtype=np.uint8)
        began_s, number, heard_by = time.monotonic(), 0, 0
        while True:
            if (count := out.get_subscription_count()) != heard_by:
                sys.stdout.write(f"listeners {(heard_by := count)}\n")
                sys.stdout.flush()
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
    return bytearray(codec_of(_IMAGE).encode(image))


if __name__ == "__main__":
    main(int(sys.argv[1]), int(sys.argv[2]), float(sys.argv[3]))
