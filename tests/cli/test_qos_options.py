from __future__ import annotations

import argparse

import pytest

from studio.cli.qos_options import add_qos_options, given_profile, is_given, listening_profile
from studio.errors import SettingsError
from studio.ros.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
FAST = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)


def options_of(*words: str) -> argparse.Namespace:
    parser = argparse.ArgumentParser()
    add_qos_options(parser)
    return parser.parse_args(words)


def test_options_change_what_they_name():
    words = ("--qos-profile", "sensor_data", "--qos-depth", "7", "--qos-durability",
             "transient_local")  # fmt: skip
    profile = given_profile(options_of(*words), QoSProfile())
    assert (profile.depth, profile.reliability) == (7, ReliabilityPolicy.BEST_EFFORT)
    assert profile.durability is DurabilityPolicy.TRANSIENT_LOCAL


def test_named_profiles_stay_as_they_are():
    given_profile(options_of("--qos-profile", "default", "--qos-depth", "9"), QoSProfile())
    assert given_profile(options_of("--qos-profile", "default"), QoSProfile()).depth == 10


def test_without_options_the_base_is_taken():
    assert not is_given(options_of())
    assert is_given(options_of("--qos-depth", "0"))
    assert given_profile(options_of(), FAST) == FAST


def test_a_depth_below_nothing_is_refused():
    with pytest.raises(SettingsError):
        given_profile(options_of("--qos-depth=-1"), FAST)


def test_t4_what_is_asked_for_is_what_all_offer():
    alone = listening_profile(options_of(), [LATCHED])
    assert (alone.reliability, alone.durability, alone.depth) == (
        ReliabilityPolicy.RELIABLE, DurabilityPolicy.TRANSIENT_LOCAL, 5,
    )  # fmt: skip
    assert listening_profile(options_of(), [LATCHED, FAST]) == FAST
    assert listening_profile(options_of(), []) == FAST
    named = options_of("--qos-profile", "default")
    assert listening_profile(named, [LATCHED]).durability is DurabilityPolicy.TRANSIENT_LOCAL
    assert listening_profile(named, [LATCHED]).depth == 10


def test_policies_that_are_given_change_sensor_data_whatever_is_offered():
    given = listening_profile(options_of("--qos-durability", "transient_local"), [LATCHED])
    assert (given.reliability, given.durability, given.depth) == (
        ReliabilityPolicy.BEST_EFFORT, DurabilityPolicy.TRANSIENT_LOCAL, 5,
    )  # fmt: skip
    reliable = options_of("--qos-reliability", "reliable")
    assert listening_profile(reliable, [FAST]).depth == 5
