from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_array_equal

from studio.errors import CdrError
from studio.ros.cdr import codec_of
from studio.ros.columns.clouds import POINT_CLOUD, read_point_cloud
from tests.support.display_messages import HEADER, STAMP_NS, TYPES, encoded
from tests.support.ros_values import values_of

KIND = TYPES.message(POINT_CLOUD)


@given(message=values_of(KIND), little=st.booleans())
def test_the_columns_are_what_the_general_reader_reads(message: Any, little: bool):  # noqa: ANN401 - made by Hypothesis
    codec = codec_of(KIND)
    data = bytes(codec.encode(message, little_endian=little))
    read, columns = codec.decode(data), read_point_cloud(data)
    assert columns.frame == read.header.frame_id
    places = np.array([(one.x, one.y, one.z) for one in read.points], np.float32).reshape(-1, 3)
    assert_array_equal(columns.points, places)
    first: dict[str, object] = {}
    for one in read.channels:
        first.setdefault(one.name, one.values)
    assert list(columns.channels) == list(first)
    for name, values in first.items():
        assert_array_equal(columns.channels[name], values)


def test_the_stamp_and_the_frame_are_the_headers():
    columns = read_point_cloud(encoded(POINT_CLOUD, {"header": HEADER}))
    assert (columns.frame, columns.stamp_ns, columns.points.shape) == ("map", STAMP_NS, (0, 3))


def test_bytes_that_end_early_are_refused():
    whole = encoded(
        POINT_CLOUD,
        {
            "header": HEADER,
            "points": [{"x": 1.0, "y": 2.0, "z": 3.0}],
            "channels": [{"name": "i", "values": [1.0]}],
        },
    )
    for end in range(len(whole)):
        with pytest.raises(CdrError):
            read_point_cloud(whole[:end])


def test_a_thousand_channels_are_read_and_no_more():
    channels = [{"name": f"c{at}", "values": [0.0]} for at in range(1001)]
    fields = {"header": HEADER, "channels": channels}
    with pytest.raises(CdrError, match="1,001 channels"):
        read_point_cloud(encoded(POINT_CLOUD, fields))
