"""Stock viser as the peer: `python -m tests.benchmarks.stock_viser LINKS` moves a robot at 60 Hz.

As a viser script is written: a frame with a box for each link, posed by its handle, all of them in
one atomic block. Prints `port N` below viser's lines.
"""

# pyright: reportUnknownMemberType=false
from __future__ import annotations

import math
import sys
import time

import viser

RATE_HZ = 60


def main(count: int) -> None:
    """Move `count` links until the process is ended."""
    server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
    links = [server.scene.add_frame(f"/robot/{n}", show_axes=False) for n in range(count)]
    for number in range(count):
        server.scene.add_box(f"/robot/{number}/box", dimensions=(0.1, 0.1, 0.1))
    sys.stdout.write(f"port {server.get_port()}\n")
    sys.stdout.flush()
    next_s = time.perf_counter()
    step = 0
    while True:
        step += 1
        with server.atomic():
            for number, link in enumerate(links):
                angle = 0.01 * step + number
                link.wxyz = (math.cos(angle), 0.0, 0.0, math.sin(angle))
                link.position = (math.cos(angle), math.sin(angle), 0.1 * number)
        next_s += 1 / RATE_HZ
        time.sleep(max(0.0, next_s - time.perf_counter()))


if __name__ == "__main__":
    main(int(sys.argv[1]))
