"""Clouds are made and read as sensor_msgs_py does, and go over the wire in between."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
import pytest

from studio.importable.point_cloud2 import (
    PointCloud2,
    PointField,
    create_cloud,
    create_cloud_xyz32,
    dtype_from_fields,
    read_points,
    read_points_list,
    read_points_numpy,
)
from studio.ros.cdr import codec_of
from studio.ros.messages import message

if TYPE_CHECKING:
    from studio.ros.types.classes import MessageValue

HEADER = message("std_msgs/msg/Header")(frame_id="lidar")
XYZ = [(1.0, 2.0, 3.0), (4.0, 5.0, math.nan), (7.0, 8.0, 9.0)]


def field(name: str, offset: int, datatype: int, count: int = 1) -> MessageValue:
    return PointField(name=name, offset=offset, datatype=datatype, count=count)


def sent(cloud: MessageValue) -> MessageValue:
    """The cloud as who receives it has it."""
    codec = codec_of(PointCloud2)
    return codec.decode(codec.encode(cloud))


def test_points_come_back_from_the_wire():
    cloud = sent(create_cloud_xyz32(HEADER, XYZ))
    assert (cloud.width, cloud.height, cloud.point_step, cloud.row_step) == (3, 1, 12, 36)
    assert cloud.header.frame_id == "lidar"
    found = read_points_numpy(cloud)
    assert found.dtype == np.float32
    np.testing.assert_array_equal(found, np.array(XYZ, np.float32))
    assert read_points(cloud).dtype.names == ("x", "y", "z")
    assert read_points_list(cloud, ("z", "x"))[0]._asdict() == {"z": 3.0, "x": 1.0}


def test_points_that_are_not_numbers_are_left_out():
    cloud = sent(create_cloud_xyz32(HEADER, np.array(XYZ, np.float32)))
    assert read_points_numpy(cloud, skip_nans=True).tolist() == [[1, 2, 3], [7, 8, 9]]
    assert read_points_numpy(cloud, ("x", "y"), skip_nans=True).shape == (3, 2)
    assert read_points_numpy(cloud, uvs=[2, 0])[:, 0].tolist() == [7, 1]


def test_fields_of_several_kinds_and_counts_are_kept():
    fields = [field("x", 0, PointField.FLOAT64), field("rgb", 8, PointField.UINT8, 3)]
    fields.append(field("", 12, PointField.INT16))
    points = [(0.5, 1, 2, 3, -4), (1.5, 5, 6, 7, -8)]
    cloud = sent(create_cloud(HEADER, fields, points, step=16))
    assert cloud.point_step == 16
    found = read_points(cloud)
    assert found.dtype.names == ("x", "rgb_0", "rgb_1", "rgb_2", "unnamed_field_2")
    assert found.tolist() == points
    again = create_cloud(HEADER, fields, found, step=16)
    assert bytes(again.data) == bytes(cloud.data)
    with pytest.raises(AssertionError, match="several datatypes"):
        read_points_numpy(cloud)
    with pytest.raises(AssertionError, match="no field intensity"):
        read_points(cloud, ("intensity",))
    with pytest.raises(ValueError, match="the fields say"):
        create_cloud(HEADER, fields[:1], found)


def test_an_organized_cloud_keeps_its_shape():
    points = np.arange(24, dtype=np.float32).reshape(4, 2, 3)
    cloud = sent(create_cloud_xyz32(HEADER, points))
    assert (cloud.width, cloud.height) == (4, 2)
    np.testing.assert_array_equal(read_points_numpy(cloud, reshape_organized_cloud=True), points)
    with pytest.raises(ValueError, match="two dimensions"):
        create_cloud_xyz32(HEADER, points[None])


def test_other_byte_orders_and_padded_rows_are_read():
    values = np.array([[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]], ">f4")
    cloud = create_cloud_xyz32(HEADER, [(0.0, 0.0, 0.0)] * 2)
    cloud.width, cloud.height, cloud.row_step, cloud.is_bigendian = 1, 2, 16, True
    cloud.data = b"".join(row.tobytes() + bytes(4) for row in values)
    assert read_points_numpy(sent(cloud)).tolist() == values.tolist()


def test_a_cloud_that_is_not_what_it_says_is_refused():
    cloud = create_cloud_xyz32(HEADER, XYZ)
    cloud.width = 1 << 31
    with pytest.raises(TypeError, match="the data has 36 bytes"):
        read_points(cloud)
    with pytest.raises(ValueError, match="at most 10000 numbers"):
        dtype_from_fields([field("x", 0, 7, 1 << 31)])
    with pytest.raises(ValueError, match="9 is no datatype"):
        dtype_from_fields([field("x", 0, 9)])
    with pytest.raises(ValueError, match="two fields are called 'x'"):
        dtype_from_fields([field("x", 0, 7), field("x", 4, 7)])
    assert read_points(PointCloud2()).size == 0
    assert read_points_list(create_cloud_xyz32(HEADER, [])) == []
