from __future__ import annotations

import io

import numpy as np
import pytest
from PIL import Image

from studio.scene.pictures import indexed_png


@pytest.mark.parametrize("size", [(1, 1), (3, 5), (300, 257)])
def test_every_pixel_comes_back_in_its_colour_and_as_opaque_as_it_was(size: tuple[int, int]):
    rng = np.random.default_rng(1)
    pixels = rng.integers(0, 256, size, np.uint8)
    palette = rng.integers(0, 256, (256, 4), np.uint8)
    with Image.open(io.BytesIO(indexed_png(pixels, palette))) as image:
        image.verify()
    with Image.open(io.BytesIO(indexed_png(pixels, palette))) as image:
        np.testing.assert_array_equal(np.asarray(image.convert("RGBA")), palette[pixels])
