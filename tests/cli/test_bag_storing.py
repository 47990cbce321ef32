from __future__ import annotations

from studio.bags import writer
from studio.cli.bag_storing import STORAGES


def test_the_storages_that_are_offered_are_those_that_are_written():
    assert STORAGES == writer.STORAGES
