from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.errors import MessageValueError
from studio.ros.columns.layout import LITTLE, nanoseconds_at, places_of, put_nanoseconds

PLACES = places_of([4], 2, 4)


@given(st.integers(-(2**31) * 10**9, 2**31 * 10**9 - 1))
def test_any_time_that_fits_survives(time_ns: int):
    written = bytearray(12)
    put_nanoseconds(written, PLACES, np.array([time_ns]), "p/msg/T")
    assert nanoseconds_at(bytes(written), PLACES, LITTLE).tolist() == [time_ns]


@pytest.mark.parametrize("time_ns", [2**31 * 10**9, -(2**31) * 10**9 - 1, 2**63 - 1])
def test_a_time_that_does_not_fit_is_refused(time_ns: int):
    with pytest.raises(MessageValueError, match="32 bits"):
        put_nanoseconds(bytearray(12), PLACES, np.array([time_ns]), "p/msg/T")
