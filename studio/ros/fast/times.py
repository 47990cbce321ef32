"""Times of many messages at once: seconds and nanoseconds of the wire as one number, and back."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from studio.errors import MessageValueError
from studio.ros.duration import NANOSECONDS
from studio.ros.fast.skeleton import LITTLE, Numbers, Places, view

if TYPE_CHECKING:
    from numpy.typing import NDArray


def nanoseconds_at(raw: bytes, places: Places, kinds: Numbers) -> NDArray[np.int64]:
    """Read times or durations.

    Args:
        raw: A whole message.
        places: Shape (N, 2), of the words of seconds and nanoseconds.
        kinds: Of its numbers.

    Returns:
        Shape (N,).
    """
    seconds = view(raw, kinds.i4).take(places[:, 0])
    rest = view(raw, kinds.u4).take(places[:, 1])
    return seconds.astype(np.int64) * NANOSECONDS + rest


def put_nanoseconds(
    written: bytearray, places: Places, times_ns: NDArray[np.int64], type_name: str
) -> None:
    """Write times into a message, little endian.

    Raises:
        MessageValueError: A time does not fit the 32 bits of its seconds.
    """
    seconds = times_ns // NANOSECONDS
    short = seconds.astype(np.int32)
    if not np.array_equal(short, seconds):
        raise MessageValueError(type_name, "a time lies beyond the 32 bits of its seconds")
    words = view(written, LITTLE.i4)
    words[places[:, 0]] = short
    # The bits of a uint32 below 10**9 are those of an int32.
    words[places[:, 1]] = times_ns - seconds * NANOSECONDS
