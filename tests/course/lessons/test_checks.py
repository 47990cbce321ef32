from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.course.lessons.checks import FORMS, LINE_MAX, Concern, read_check
from studio.errors import LessonError

CASES: dict[str, tuple[str, dict[str, str]]] = {
    "property wheel_radius is 0.1": ("property", {"name": "wheel_radius", "value": "0.1"}),
    "property limits.speed.max is 2.0 * pi": (
        "property",
        {"name": "limits.speed.max", "value": "2.0 * pi"},
    ),
    "argument lidar is puck": ("argument", {"name": "lidar", "value": "puck"}),
    "link base_link has 4 children": ("children", {"name": "base_link", "count": "4"}),
    "link mast has 1 child": ("children", {"name": "mast", "count": "1"}),
    "link mast is there": ("link", {"name": "mast"}),
    "joint wheel_joint is continuous": ("joint", {"name": "wheel_joint", "type": "continuous"}),
    "no errors": ("no_errors", {}),
    "node /talker runs": ("node", {"name": "/talker"}),
    "topic /chatter is of std_msgs/String": (
        "topic_type",
        {"name": "/chatter", "type": "std_msgs/msg/String"},
    ),
    "topic /chatter has 2 publishers": ("publishers", {"name": "/chatter", "count": "2"}),
    "topic /chatter has 1 subscription": ("subscriptions", {"name": "/chatter", "count": "1"}),
    "topic /t comes at 1 Hz ± 5 %": ("rate", {"name": "/t", "rate": "1", "percent": "5"}),
    "topic  /t comes at 0.5 Hz+/-5%": ("rate", {"name": "/t", "rate": "0.5", "percent": "5"}),
    "topic /t comes at 30 Hz": ("rate", {"name": "/t", "rate": "30", "percent": "10"}),
    "topic /t is published best_effort": (
        "published",
        {"name": "/t", "reliability": "best_effort"},
    ),
    "topic /t is subscribed reliable transient_local": (
        "subscribed",
        {"name": "/t", "reliability": "reliable", "durability": "transient_local"},
    ),
    "service /add is of example_interfaces/srv/AddTwoInts": (
        "service_type",
        {"name": "/add", "type": "example_interfaces/srv/AddTwoInts"},
    ),
    "service /add has 1 server": ("servers", {"name": "/add", "count": "1"}),
    "service /add answers {sum: 42} to {a: 41, b: 1}": (
        "answers",
        {"name": "/add", "response": "{sum: 42}", "request": "{a: 41, b: 1}"},
    ),
    "action /fibonacci is of example_interfaces/Fibonacci": (
        "action_type",
        {"name": "/fibonacci", "type": "example_interfaces/action/Fibonacci"},
    ),
    "parameter /turtlesim background_r is 255": (
        "parameter",
        {"node": "/turtlesim", "name": "background_r", "value": "255"},
    ),
    "tf leads from odom to base_link": ("tf", {"parent": "odom", "child": "base_link"}),
    "opened origin": ("opened", {"panel": "origin"}),
    "package my_robot has no problems": ("package", {"name": "my_robot"}),
}


@pytest.mark.parametrize("line", CASES)
def test_a_check_is_read_by_its_form(line: str):
    kind, values = CASES[line]
    check = read_check(line)
    assert (check.kind, dict(check.values)) == (kind, values)


def test_every_form_has_a_case_and_says_what_it_looks_at():
    assert {form.kind for form in FORMS} == {kind for kind, _ in CASES.values()}
    assert {form.concern for form in FORMS} == set(Concern)


FAULTS = {
    "topic /x at 1 Hz": "write it as `topic /NAME comes at RATE Hz[ ± PERCENT %]`.",
    "link base has many children": "write it as `link NAME has COUNT children`.",
    "topic /x is of std_msgs/srv/Empty": "write it as `std_msgs/msg/Empty`.",
    "topic /x comes at 0 Hz": "nothing comes at 0 Hz.",
    "node talker runs": "write it as `node /NAME runs`.",
    "x" * (LINE_MAX + 1): f"A check has {LINE_MAX} characters at most",
}


@pytest.mark.parametrize("line", FAULTS)
def test_what_is_no_check_is_refused_with_the_form_that_it_is_most_like(line: str):
    with pytest.raises(LessonError) as refused:
        read_check(line)
    assert FAULTS[line] in str(refused.value)


NEARLY = st.one_of([st.from_regex(form.pattern) for form in FORMS])


@given(st.text(max_size=500) | NEARLY)
def test_any_line_is_a_check_or_refused(line: str):
    try:
        check = read_check(line)
    except LessonError:
        return
    assert all(check.values.values())
