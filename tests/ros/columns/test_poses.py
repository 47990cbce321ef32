from __future__ import annotations

from time import thread_time
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.errors import CdrError
from studio.ros.cdr import Codec
from studio.ros.columns.poses import (
    GRID_CELLS,
    PATH,
    POLYGON,
    POSE_ARRAY,
    read_grid_cells,
    read_path,
    read_polygon,
    read_pose_array,
)
from studio.ros.types.library import TypeLibrary
from tests.support.fast_values import xyz
from tests.support.ros_values import values_of

if TYPE_CHECKING:
    from collections.abc import Callable

LIBRARY = TypeLibrary("jazzy")
CODECS = {name: Codec(LIBRARY.message(name)) for name in (POSE_ARRAY, PATH, POLYGON, GRID_CELLS)}
READERS: dict[str, Callable[[bytes], Any]] = {
    POSE_ARRAY: read_pose_array,
    PATH: read_path,
    POLYGON: read_polygon,
    GRID_CELLS: read_grid_cells,
}


def pose_row(pose: Any) -> tuple[float, ...]:  # noqa: ANN401
    turn = pose.orientation
    return *xyz(pose.position), turn.x, turn.y, turn.z, turn.w


def expected(name: str, message: Any) -> tuple[object, ...]:  # noqa: ANN401
    """What the codec says: frame, stamp, rows, and the sizes of cells."""
    header = message.header
    head = (header.frame_id, header.stamp.sec * 10**9 + header.stamp.nanosec)
    match name:
        case "geometry_msgs/msg/PoseArray":
            return *head, [pose_row(one) for one in message.poses]
        case "nav_msgs/msg/Path":
            return *head, [pose_row(one.pose) for one in message.poses]
        case "geometry_msgs/msg/PolygonStamped":
            return *head, [xyz(one) for one in message.polygon.points]
        case _:
            cells = [xyz(one) for one in message.cells]
            return *head, cells, message.cell_width, message.cell_height


def read(name: str, raw: bytes) -> tuple[object, ...]:
    found = READERS[name](raw)
    rows, rest = (found.cells, found[1:]) if name == GRID_CELLS else (found, ())
    assert rows.rows.dtype == np.float64
    return rows.frame, rows.stamp_ns, [tuple(row) for row in rows.rows.tolist()], *rest


def assert_alike(name: str, raw: bytes) -> None:
    try:
        wanted = expected(name, CODECS[name].decode(raw))
    except CdrError:
        with pytest.raises(CdrError):
            READERS[name](raw)
        return
    np.testing.assert_equal(read(name, raw), wanted)


@pytest.mark.parametrize("name", CODECS)
@settings(max_examples=60, deadline=None)
@given(data=st.data(), little=st.booleans())
def test_any_message_reads_as_the_codec_reads_it(name: str, data: st.DataObject, little: bool):
    value = data.draw(values_of(LIBRARY.message(name)))
    assert_alike(name, bytes(CODECS[name].encode(value, little_endian=little)))


@pytest.mark.parametrize("name", CODECS)
@settings(max_examples=100, deadline=None)
@given(head=st.sampled_from([b"", b"\0\1\0\0", b"\0\0\0\0"]), body=st.binary(max_size=200))
def test_any_bytes_are_read_as_the_codec_reads_them_or_refused_with_it(
    name: str, head: bytes, body: bytes
):
    assert_alike(name, head + body)


def path(frames: list[str]) -> bytes:
    kind = LIBRARY.message(PATH)
    stamped = LIBRARY.message("geometry_msgs/msg/PoseStamped")
    made: Any = kind(poses=[stamped() for _ in frames])
    made.header.frame_id = "map"
    for number, (one, frame) in enumerate(zip(made.poses, frames, strict=True)):
        one.header.frame_id = frame
        one.pose.position.x = number + 0.5
    return bytes(CODECS[PATH].encode(made))


@pytest.mark.parametrize(
    "frames",
    [[], ["map"], ["map"] * 5, [""] * 5, ["map", "", ""], ["", "map", "odom"], ["ab", "cd", "ef"]],
)
def test_a_path_is_read_whatever_frames_its_poses_name(frames: list[str]):
    assert_alike(PATH, path(frames))
    assert read_path(path(frames)).rows[:, 0].tolist() == [k + 0.5 for k in range(len(frames))]


@settings(max_examples=300, deadline=None)
@given(at=st.integers(0, 600), byte=st.integers(0, 255))
def test_a_byte_of_a_path_that_changed_is_read_as_the_codec_reads_it(at: int, byte: int):
    raw = bytearray(path(["map"] * 6))
    raw[at % len(raw)] = byte
    assert_alike(PATH, bytes(raw))


def test_bytes_between_poses_that_say_nothing_do_not_matter():
    raw = bytearray(path(["abcd"] * 4))
    whole = read_path(bytes(raw)).rows
    # Behind "abcd" and its zero there are three bytes that only fill up to the next number.
    filling = [at + 5 for at in range(len(raw)) if raw.startswith(b"abcd\0", at)]
    for at in filling[1:]:
        raw[at : at + 3] = b"\xff\xfe\xfd"
    np.testing.assert_array_equal(read_path(bytes(raw)).rows, whole)


@pytest.mark.parametrize("name", CODECS)
def test_a_count_that_no_bytes_follow_is_refused_at_once(name: str):
    raw = bytearray(CODECS[name].encode(LIBRARY.message(name)()))
    raw[-4:] = b"\xff\xff\xff\xff"
    with pytest.raises(CdrError, match="4294967295 items"):
        READERS[name](bytes(raw))


def test_a_million_poses_are_read_in_a_moment():
    raw = a_million_poses()
    before = thread_time()
    assert len(read_path(raw).rows) == 1_000_000
    assert thread_time() - before < 10


def a_million_poses() -> bytes:
    """A path made of the bytes of one of three poses, the last of them repeated."""
    three, step = path(["map"] * 3), 72
    many = three + three[-step:] * 999_997
    at = three.index(b"\3\0\0\0", 12)
    return many[:at] + (1_000_000).to_bytes(4, "little") + many[at + 4 :]
