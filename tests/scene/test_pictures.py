from __future__ import annotations

import io
import math

import numpy as np
import pytest
from PIL import Image

from studio.displays.drawing import Frustum, Picture
from studio.scene.pictures import TILE_PX, EncodedShelf, frustum_of, tiles_of


def noise(rows: int, columns: int) -> np.ndarray:
    return np.random.default_rng(1).integers(0, 256, (rows, columns, 4), np.uint8)


def test_a_picture_comes_back_as_it_was_with_its_middle_in_place():
    pixels = noise(3, 5)
    (tile,) = tiles_of(Picture(pixels, (1.0, 0.6), (10, 20, 1)), EncodedShelf()).values()
    with Image.open(io.BytesIO(tile.flowing["_data"].tobytes())) as image:
        np.testing.assert_array_equal(np.asarray(image), pixels)
    assert tile.position == pytest.approx((10.5, 20.3, 1))
    assert (tile.props["render_width"], tile.props["render_height"]) == pytest.approx((1.0, 0.6))


def test_a_turned_picture_turns_about_its_corner():
    quarter = (math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5))  # about z
    picture = Picture(noise(2, 2), (2.0, 4.0), (1, 1, 0), quarter)
    (tile,) = tiles_of(picture, EncodedShelf()).values()
    assert tile.position == pytest.approx((1 - 2, 1 + 1, 0))


def test_tiles_of_a_large_picture_lie_side_by_side_and_only_a_changed_one_is_another():
    pixels = noise(TILE_PX + 10, TILE_PX + 20)
    shelf = EncodedShelf()
    size_m = (pixels.shape[1] * 0.05, pixels.shape[0] * 0.05)
    before = tiles_of(Picture(pixels, size_m), shelf)
    assert set(before) == {"0-0", "0-1", "1-0", "1-1"}
    width_m = [before[name].props["render_width"] for name in ("0-0", "0-1")]
    assert width_m == pytest.approx([TILE_PX * 0.05, 1.0])
    assert before["0-1"].position == pytest.approx((TILE_PX * 0.05 + 0.5, TILE_PX * 0.025, 0))
    changed = pixels.copy()
    changed[-1, -1] ^= 255
    after = tiles_of(Picture(changed, size_m), shelf)
    assert {name for name in after if after[name] != before[name]} == {"1-1"}
    assert all(after[name].flowing["_data"] is before[name].flowing["_data"] for name in ("0-0",))


def test_pixels_in_another_shape_are_another_picture():
    pixels = noise(2, 8)
    turned = np.ascontiguousarray(pixels).reshape(4, 4, 4)
    (one,) = tiles_of(Picture(pixels, (1, 1)), EncodedShelf()).values()
    (other,) = tiles_of(Picture(turned, (1, 1)), EncodedShelf()).values()
    assert one.stream != other.stream


def test_encoded_pictures_are_kept_up_to_a_size():
    shelf = EncodedShelf()
    rng = np.random.default_rng(2)
    for number in range(40):
        pixels = rng.integers(0, 256, (512, 512, 4), np.uint8)
        shelf.png(pixels, str(number))
    assert shelf.kept_bytes <= 32 << 20
    assert shelf.kept_bytes > 24 << 20


@pytest.mark.parametrize("aspect", [0.5, 1.0, 16 / 9])
def test_a_frustum_is_as_long_as_it_is_said_to_be(aspect: float):
    drawn = frustum_of(Frustum(1.2, aspect, 3.0), "1")
    half_y = math.tan(0.6)
    # As viser's page computes it: the far end at 1 before it is scaled to a volume.
    far_m = drawn.props["scale"] / np.cbrt(half_y * half_y * aspect / 3)
    assert far_m == pytest.approx(3.0)


def test_a_large_camera_picture_is_thinned_out():
    image = np.zeros((3000, 4000, 3), np.uint8)
    drawn = frustum_of(Frustum(1.0, 4 / 3, 1.0, image), "1")
    with Image.open(io.BytesIO(drawn.flowing["_image_data"].tobytes())) as small:
        assert small.size == (1000, 750)


def test_the_same_cells_in_other_colours_are_another_picture():
    cells = np.arange(12, dtype=np.uint8).reshape(3, 4)
    colours = [np.full((256, 4), value, np.uint8) for value in (1, 2)]
    tiles = [
        next(iter(tiles_of(Picture(cells, (1, 1), palette=one), EncodedShelf()).values()))
        for one in colours
    ]
    assert tiles[0].stream != tiles[1].stream
    with Image.open(io.BytesIO(tiles[1].flowing["_data"].tobytes())) as image:
        np.testing.assert_array_equal(np.asarray(image.convert("RGBA")), colours[1][cells])
