import numpy as np
import pytest

from studio.ros.cdr import codec_of
from studio.ros.columns.transforms import TransformCodec
from studio.ros.types.convert import from_dict
from studio.ros.types.library import TypeLibrary
from studio.tf.buffer import TransformBuffer
from studio.tf.transforms import TransformColumns

MESSAGE = TypeLibrary("jazzy").message("tf2_msgs/msg/TFMessage")


def transform(parent: str, child: str, sec: int, x_m: float) -> dict[str, object]:
    return {
        "header": {"frame_id": parent, "stamp": {"sec": sec, "nanosec": 5}},
        "child_frame_id": child,
        "transform": {
            "translation": {"x": x_m, "y": 2.0, "z": 3.0},
            "rotation": {"x": 0.0, "y": 0.0, "z": 0.6, "w": 0.8},
        },
    }


@pytest.mark.parametrize("little", [True, False])
def test_what_comes_from_the_wire_is_taken_as_it_is_read(little: bool):
    buffer, codec = TransformBuffer(), TransformCodec()
    for sec in (1, 2):
        rows = [transform("/map", "base", sec, sec * 1.0), transform("base", "arm", sec, 0.0)]
        told = from_dict(MESSAGE, {"transforms": rows})
        raw = codec_of(MESSAGE).encode(told, little_endian=little)
        assert buffer.put(codec.decode(raw), publisher="driver") == ()
    wxyz, xyz, stamp_ns = buffer.fixed_from("map", "base", 1_500_000_005)
    assert wxyz == pytest.approx((0.8, 0.0, 0.0, 0.6))
    assert (xyz, stamp_ns) == ((1.5, 2.0, 3.0), 1_500_000_005)
    assert buffer.fixed_from("map", "arm").stamp_ns == 2_000_000_005


def test_columns_of_ones_own_are_taken_alike():
    buffer = TransformBuffer()
    own = TransformColumns(
        ("map",), ("base",), np.array([5]), np.array([[1.0, 2.0, 3.0]]), np.array([[1.0, 0, 0, 0]])
    )
    assert buffer.put(own) == ()
    assert buffer.fixed_from("map", "base") == ((1, 0, 0, 0), (1, 2, 3), 5)
