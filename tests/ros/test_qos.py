from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.errors import TokenError
from studio.ros.duration import INFINITE, Duration
from studio.ros.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSProfile,
    ReliabilityPolicy,
    as_profile,
    parse_qos,
    qos_profile_action_status_default,
    qos_profile_best_available,
    qos_profile_parameters,
    qos_profile_rosout_default,
    qos_profile_sensor_data,
    qos_profile_services_default,
    qos_profile_system_default,
    qos_text,
)

GOLDEN = [
    (QoSProfile(depth=10), "::,10:,:,:,,"),
    (QoSProfile(depth=42), "::,:,:,:,,"),
    (QoSProfile(depth=0), "::,:,:,:,,"),
    (qos_profile_sensor_data, "2::,5:,:,:,,"),
    (qos_profile_action_status_default, ":1:,1:,:,:,,"),
    (qos_profile_services_default, "::,10:,:,:,,"),
    (qos_profile_parameters, "::,1000:,:,:,,"),
    (QoSProfile(history=HistoryPolicy.KEEP_ALL), "::2,:,:,:,,"),
    (qos_profile_rosout_default, ":1:,1000:,:10,0:,,"),
    (qos_profile_system_default, "::,:,:,:,,"),
    (qos_profile_best_available, "4:4:,10:,:,:5,,"),
    (QoSProfile(depth=1, deadline=INFINITE), "::,1:,:,:,,"),
    (QoSProfile(depth=1, deadline=Duration(seconds=0.5)), "::,1:0,500000000:,:,,"),
]


@pytest.mark.parametrize(("profile", "text"), GOLDEN)
def test_a_profile_is_written_as_rmw_zenoh_does(profile: QoSProfile, text: str):
    assert qos_text(profile) == text


@pytest.mark.parametrize("text", sorted({text for _, text in GOLDEN}))
def test_what_was_written_reads_the_same(text: str):
    assert qos_text(parse_qos(text)) == text


def test_an_empty_depth_is_forty_two():
    assert parse_qos("::,:,:,:,,").depth == 42


def test_more_fields_than_today_are_passed_over():
    assert parse_qos("2:1:2,3,9:,:,:,,,:more").reliability is ReliabilityPolicy.BEST_EFFORT


@pytest.mark.parametrize(
    "text",
    ["", ":", "::,10:,:,:,", "::10:,:,:,,", "x::,:,:,:,,", "-1::,:,:,:,,", "7::,:,:,:,,",
     "::,:,-1:,:,,", "::,99999999999999999999999:,:,:,,", ":²:,:,:,:,,", ": 1:,:,:,:,,"],
)  # fmt: skip
def test_a_text_that_rmw_zenoh_would_drop_is_refused(text: str):
    with pytest.raises(TokenError):
        parse_qos(text)


def test_a_depth_alone_makes_a_profile_and_a_given_one_is_not_shared():
    assert as_profile(7) == QoSProfile(depth=7)
    mine = as_profile(qos_profile_sensor_data)
    mine.depth = 99
    assert qos_profile_sensor_data.depth == 5


DURATIONS = st.integers(1, INFINITE.nanoseconds - 1).map(lambda ns: Duration(nanoseconds=ns))


@given(
    st.builds(
        QoSProfile,
        history=st.sampled_from(list(HistoryPolicy)[1:]),
        depth=st.integers(1, 2**31),
        reliability=st.sampled_from(list(ReliabilityPolicy)[1:]),
        durability=st.sampled_from(list(DurabilityPolicy)[1:]),
        lifespan=st.just(Duration()) | DURATIONS,
        deadline=st.just(Duration()) | DURATIONS,
        liveliness=st.sampled_from(list(LivelinessPolicy)[1:]),
        liveliness_lease_duration=st.just(Duration()) | DURATIONS,
    )
)
def test_any_profile_survives(profile: QoSProfile):
    assert parse_qos(qos_text(profile)) == profile


@given(st.text(alphabet="0123456789:,-x", max_size=40))
def test_any_text_is_a_profile_or_refused_by_name(text: str):
    try:
        profile = parse_qos(text)
    except TokenError:
        return
    assert parse_qos(qos_text(profile)).reliability in {
        profile.reliability,
        ReliabilityPolicy.RELIABLE,
    }
