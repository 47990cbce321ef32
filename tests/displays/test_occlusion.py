import math

import numpy as np
from numpy.testing import assert_array_equal

from studio.displays.occlusion import Occlusion

S = 1_000_000_000
NAN = math.nan


def image(*depths_m: float) -> np.ndarray[tuple[int, int], np.dtype[np.float32]]:
    return np.array([depths_m], np.float32)


def test_what_something_nearer_hides_is_kept_until_its_time_is_over():
    seen = Occlusion()
    assert_array_equal(seen.hidden(image(2, 3, NAN), 0, 10), [[NAN, NAN, NAN]])
    assert_array_equal(seen.hidden(image(1, 3.01, 1), 1 * S, 10), [[2, NAN, NAN]])
    assert_array_equal(seen.hidden(image(1, 3, 1), 9 * S, 10), [[2, NAN, NAN]])
    assert_array_equal(seen.hidden(image(1, 3, 1), 11 * S, 10), [[NAN, NAN, NAN]])


def test_what_is_seen_again_is_no_more_hidden():
    seen = Occlusion()
    seen.hidden(image(2), 0, 10)
    assert_array_equal(seen.hidden(image(1), 1, 10), [[2]])
    assert_array_equal(seen.hidden(image(2.2), 2, 10), [[NAN]])
    assert_array_equal(seen.hidden(image(1), 3, 10), [[np.float32(2.2)]])


def test_where_nothing_is_measured_nothing_is_hidden():
    seen = Occlusion()
    seen.hidden(image(2, 2), 0, 10)
    assert_array_equal(seen.hidden(image(NAN, 0), 1, 10), [[NAN, NAN]])


def test_a_picture_of_another_size_begins_anew():
    seen = Occlusion()
    seen.hidden(image(2), 0, 10)
    assert_array_equal(seen.hidden(image(1, 1), 1, 10), [[NAN, NAN]])
