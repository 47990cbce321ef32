from __future__ import annotations

import numpy as np

from studio.ros.columns.layout import KnownLayouts, Skeleton, places_of

HEAD = b"\0\1\0\0"


class Layout:
    def __init__(self, raw: bytes) -> None:
        self.skeleton = Skeleton(raw, [np.array([1])])


def test_only_the_words_of_numbers_may_differ():
    skeleton = Skeleton(HEAD + b"aaaabbbbccccd", [np.array([[1]])])
    assert skeleton.fits(HEAD + b"aaaaXXXXccccd")
    assert not skeleton.fits(HEAD + b"aaaabbbbcccXd")
    assert not skeleton.fits(HEAD + b"aaaabbbbccccX")
    assert not skeleton.fits(b"\0\0\0\0" + b"aaaabbbbccccd")


def test_layouts_of_one_length_are_told_apart_and_the_oldest_go():
    known: KnownLayouts[Layout] = KnownLayouts()
    raws = [HEAD + b"%04d....%04d" % (number, number) for number in range(6)]
    for raw in raws:
        assert known.find(raw) is None
        known.keep(raw, Layout(raw))
    assert [known.find(raw) is not None for raw in raws] == [False, False, True, True, True, True]


def test_places_are_counted_behind_the_header():
    assert places_of([4, 28], 2, 8).tolist() == [[0, 1], [3, 4]]
    assert places_of([4], [6, 3], 8).tolist() == [[6, 3]]
