from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.bags.qos_overrides import BYTES_MAX, read_qos_overrides
from studio.errors import SettingsError
from studio.ros.duration import Duration
from studio.ros.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSProfile,
    ReliabilityPolicy,
)

if TYPE_CHECKING:
    from pathlib import Path

FULL = """\
/talker:
  history: keep_all
  depth: 3
  reliability: best_effort
  durability: transient_local
  deadline: {sec: 0, nsec: 10}
  lifespan: {sec: 9223372036, nsec: 854775807}
  liveliness: automatic
  liveliness_lease_duration: {sec: 1, nsec: 500000000}
  avoid_ros_namespace_conventions: false
scan:
  depth: 5
"""


def test_a_file_says_the_profile_of_each_topic(tmp_path: Path):
    file = tmp_path / "qos.yaml"
    file.write_text(FULL)
    assert read_qos_overrides(file) == {
        "/talker": QoSProfile(
            history=HistoryPolicy.KEEP_ALL,
            depth=3,
            reliability=ReliabilityPolicy.BEST_EFFORT,
            durability=DurabilityPolicy.TRANSIENT_LOCAL,
            deadline=Duration(nanoseconds=10),
            liveliness=LivelinessPolicy.AUTOMATIC,
            liveliness_lease_duration=Duration(seconds=1.5),
        ),
        "/scan": QoSProfile(depth=5),
    }


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("/t: {depth: -1}", "depth cannot be -1"),
        ("/t: {depth: many}", "depth cannot be 'many'"),
        ("/t: {history: keep_some}", "but system_default, keep_last, keep_all"),
        ("/t: {reliability: reliable}", "neither history nor depth"),
        ("/t: {depth: 1, colour: red}", "colour is no policy"),
        ("/t: {depth: 1, deadline: {sec: 1}}", "needs both sec and nsec"),
        ("/t: {depth: 1, deadline: {sec: -1, nsec: 0}}", "below zero"),
        ("/t: {depth: 1, deadline: {sec: one, nsec: 0}}", "whole numbers"),
        ("/t: {depth: 1, deadline: 5}", "must be a mapping"),
        ("/t: fast", "must be a mapping"),
        ("- /t", "must be a mapping"),
        ("", "must be a mapping"),
        ("/t: [", "is no YAML"),
        ("[" * 5_000, "deep"),
        ("#" * (BYTES_MAX + 1), "larger than"),
    ],
)
def test_what_is_wrong_in_a_file_is_said(tmp_path: Path, text: str, said: str):
    file = tmp_path / "qos.yaml"
    file.write_text(text)
    with pytest.raises(SettingsError, match=said) as raised:
        read_qos_overrides(file)
    assert "qos.yaml" in str(raised.value)


def test_a_file_that_is_not_there_is_said(tmp_path: Path):
    with pytest.raises(SettingsError, match="cannot be read"):
        read_qos_overrides(tmp_path / "none.yaml")
