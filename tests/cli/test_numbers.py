from __future__ import annotations

import argparse

import pytest

from studio.cli.numbers import count, whole


def test_a_number_is_refused_below_its_least():
    assert (count("1"), whole("0")) == (1, 0)
    with pytest.raises(argparse.ArgumentTypeError, match="0 is too few: give 1 or more"):
        count("0")
    with pytest.raises(argparse.ArgumentTypeError, match="-1 is less than 0"):
        whole("-1")
