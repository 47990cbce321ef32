from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.errors import CdrError, MessageValueError
from studio.ros.cdr import codec_of
from studio.ros.columns.markers import MarkerCodec, MarkerColumns, MarkerTexts, Texture
from studio.ros.types.library import TypeLibrary
from tests.support.fast_values import assert_same, marker_columns
from tests.support.ros_values import values_of

LIBRARY = TypeLibrary("jazzy")
MARKERS = LIBRARY.message("visualization_msgs/msg/MarkerArray")
MARKER = LIBRARY.message("visualization_msgs/msg/Marker")
POINT = LIBRARY.message("geometry_msgs/msg/Point")
COLOR = LIBRARY.message("std_msgs/msg/ColorRGBA")
UV = LIBRARY.message("visualization_msgs/msg/UVCoordinate")
CODEC = codec_of(MARKERS)
FAST = MarkerCodec()


def marker(number: int = 0, **fields: Any) -> Any:  # noqa: ANN401
    made: Any = MARKER(**{"ns": "lane", "id": number, "type": 4, **fields})
    made.header.frame_id = "map"
    made.pose.position.x = number / 2
    made.color.a = 1.0
    return made


def lines(count: int) -> Any:  # noqa: ANN401
    """Lines of ever more points, which put each next marker at another alignment."""
    return MARKERS(
        markers=[
            marker(
                number,
                text="x" * number,
                points=[POINT(x=float(place)) for place in range(number)],
                colors=[COLOR(r=0.5)] * (number % 3),
                uv_coordinates=[UV(u=0.5)] * (number % 2),
            )
            for number in range(count)
        ]
    )


def columns_of(message: Any) -> MarkerColumns:  # noqa: ANN401
    return MarkerCodec().decode(CODEC.encode(message))


@settings(max_examples=60, deadline=None)
@given(values_of(MARKERS), st.booleans())
def test_any_message_reads_as_the_codec_reads_it(value: Any, little: bool):  # noqa: ANN401
    written = CODEC.encode(value, little_endian=little)
    for codec in (MarkerCodec(), FAST, FAST):
        assert_same(codec.decode(written), marker_columns(CODEC.decode(written)))


@settings(max_examples=60, deadline=None)
@given(values_of(MARKERS))
def test_what_was_read_is_written_as_it_was(value: Any):  # noqa: ANN401
    for one in value.markers:
        for time in (one.header.stamp, one.lifetime, one.texture.header.stamp):
            time.nanosec %= 10**9
    read = FAST.decode(CODEC.encode(value))
    assert_same(marker_columns(CODEC.decode(FAST.encode(read))), read)


def test_lists_of_several_markers_lie_one_after_another():
    read = columns_of(lines(6))
    assert_same(read, marker_columns(lines(6)))
    third = read.points[read.point_starts[3] : read.point_starts[4]]
    assert third[:, 0].tolist() == [0.0, 1.0, 2.0]


@pytest.mark.parametrize("little", [True, False])
def test_markers_built_alike_are_read_one_by_one_where_they_differ(little: bool):
    odd = [{}, {"text": "x"}, {"ns": "lanf"}, {"points": [POINT(x=1.0)]}, {"frame_locked": True},
           {"mesh_use_embedded_materials": True}, {"uv_coordinates": [UV(u=0.5)]}]  # fmt: skip
    rows = [marker(number, **(odd[number // 4 % len(odd)])) for number in range(60)]
    message = MARKERS(markers=[one for pair in zip(rows, rows[::-1], strict=True) for one in pair])
    written = CODEC.encode(message, little_endian=little)
    assert_same(MarkerCodec().decode(written), marker_columns(message))


def test_the_bytes_are_those_of_the_codec():
    written = bytes(CODEC.encode(lines(6)))
    assert bytes(MarkerCodec().encode(columns_of(lines(6)))) == written


def test_texts_are_the_same_object_while_only_numbers_change():
    fast = MarkerCodec()
    first = fast.decode(CODEC.encode(lines(4)))
    moved = replace(first, positions=first.positions + 1, frame_locked=~first.frame_locked)
    second = fast.decode(fast.encode(moved))
    assert second.texts is first.texts
    assert_same(second, moved)


@pytest.mark.parametrize(
    "change",
    [
        {"text": "xy"}, {"ns": "lanf"}, {"mesh_use_embedded_materials": True},
        {"mesh_resource": "package://p/m.dae"}, {"texture_resource": "t"},
    ],
)  # fmt: skip
def test_another_text_is_seen_at_once(change: dict[str, Any]):
    fast = MarkerCodec()
    fast.decode(CODEC.encode(MARKERS(markers=[marker(1, text="x")])))
    changed = marker(1, text="x")
    for name, value in change.items():
        setattr(changed, name, value)
    message = MARKERS(markers=[changed])
    assert_same(fast.decode(CODEC.encode(message)), marker_columns(message))


def test_a_picture_and_a_mesh_that_are_sent_along_arrive_whole():
    one = marker()
    one.texture.header.stamp.sec, one.texture.format = 5, "png"
    one.texture.data, one.mesh_file.data = list(range(7)), [1, 2, 3]
    one.mesh_file.filename = "m.dae"
    read = columns_of(MARKERS(markers=[one, marker(1)]))
    assert read.texts[0].texture == Texture(5 * 10**9, "", "png", bytes(range(7)))
    assert read.texts[0].mesh_file_data == b"\1\2\3"
    assert read.texts[1] == MarkerTexts("map", "lane")
    assert_same(columns_of(CODEC.decode(MarkerCodec().encode(read))), read)


@settings(max_examples=60, deadline=None)
@given(values_of(MARKER), st.booleans())
def test_a_single_marker_reads_as_the_codec_reads_it(value: Any, little: bool):  # noqa: ANN401
    written = codec_of(MARKER).encode(value, little_endian=little)
    array = MARKERS(markers=[codec_of(MARKER).decode(written)])
    for codec in (MarkerCodec(), FAST, FAST):
        assert_same(codec.decode_single(written), marker_columns(array))


def test_a_single_marker_and_an_array_are_never_taken_for_each_other():
    fast = MarkerCodec()
    single = bytes(codec_of(MARKER).encode(marker(1, text="x")))
    assert fast.decode_single(single).ids.tolist() == [1]
    # Its stamp of zero reads as an array of no markers.
    assert fast.decode(single).ids.tolist() == []
    assert fast.decode_single(single).ids.tolist() == [1]
    with pytest.raises(CdrError, match=r"msgs/msg/Marker\b"):
        fast.decode_single(single[:50])


def assert_alike(raw: bytes) -> None:
    try:
        expected = marker_columns(CODEC.decode(raw))
    except CdrError:
        with pytest.raises(CdrError):
            FAST.decode(raw)
        return
    assert_same(FAST.decode(raw), expected)


@settings(max_examples=300, deadline=None)
@given(st.sampled_from([b"", b"\0\1\0\0", b"\0\0\0\0"]), st.binary(max_size=500))
def test_any_bytes_are_read_as_the_codec_reads_them_or_refused_with_it(head: bytes, body: bytes):
    assert_alike(head + body)


@settings(max_examples=300, deadline=None)
@given(st.integers(0, 10_000), st.integers(0, 255), st.booleans())
def test_a_byte_that_changed_is_read_as_the_codec_reads_it_or_refused_with_it(
    at: int, byte: int, little: bool
):
    raw = bytearray(CODEC.encode(lines(3), little_endian=little))
    raw[at % len(raw)] = byte
    assert_alike(bytes(raw))


@pytest.mark.parametrize("little", [True, False])
def test_a_message_that_ends_too_early_is_refused(little: bool):
    whole = bytes(CODEC.encode(lines(3), little_endian=little))
    for end in range(len(whole)):
        with pytest.raises(CdrError):
            FAST.decode(whole[:end])


def test_a_count_that_no_bytes_follow_is_refused_at_once():
    with pytest.raises(CdrError, match="4294967295 items"):
        MarkerCodec().decode(b"\0\1\0\0" + b"\xff" * 400)


def test_columns_that_do_not_fit_are_not_sent():
    whole = columns_of(lines(3))
    wrong = [
        replace(whole, ids=whole.ids[:2]),
        replace(whole, points=whole.points[:-1]),
        replace(whole, point_starts=whole.point_starts[::-1]),
        replace(whole, uv_starts=whole.uv_starts[:-1]),
        replace(whole, lifetimes_ns=whole.lifetimes_ns + 2**62),
        replace(whole, texts=(*whole.texts[:2], MarkerTexts("map", "\ud800"))),
        replace(
            whole,
            texts=(*whole.texts[:2], MarkerTexts("", "", texture=Texture(2**63, "", "", b""))),
        ),
    ]
    for each in wrong:
        with pytest.raises(MessageValueError, match="MarkerArray"):
            MarkerCodec().encode(each)


def test_ever_new_texts_fill_no_memory():
    fast = MarkerCodec()
    for number in range(300):
        text = "x" * (number % 90) + str(number)
        fast.encode(fast.decode(CODEC.encode(MARKERS(markers=[marker(text=text)]))))
    assert fast.layouts_kept <= 16 * 4
    huge = marker(text="x" * (1 << 20))
    fast.decode(CODEC.encode(MARKERS(markers=[huge])))
    assert fast.layouts_kept <= 16 * 4
    assert np.all(fast.decode(CODEC.encode(MARKERS(markers=[huge]))).ids == 0)
