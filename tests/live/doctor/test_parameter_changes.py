"""Which parameters changed, of events as nodes send them, within bounds."""

from __future__ import annotations

from typing import Any

from studio.live.doctor.parameter_changes import EVENT_TYPE, ParameterChanges
from studio.live.doctor.seen import ChangedParameter
from studio.ros.cdr import codec_of
from studio.ros.messages import message
from studio.ros.parameters.parameter import Parameter
from studio.ros.types.library import TypeLibrary

TYPES = TypeLibrary("jazzy")
FIRST, SECOND = b"1" * 16, b"2" * 16


def event(node: str, **kinds: dict[str, int]) -> bytes:
    """An event of a node; `new`, `changed` and `deleted` are values by name."""
    made: Any = message(EVENT_TYPE)(node=node)
    for kind, values in kinds.items():
        of_kind = [
            Parameter(name, value=value).to_parameter_msg() for name, value in values.items()
        ]
        setattr(made, f"{kind}_parameters", of_kind)
    return bytes(codec_of(TYPES.message(EVENT_TYPE)).encode(made))


def changes_of(*events: tuple[bytes, bytes]) -> dict[tuple[str, str], ChangedParameter]:
    """What is known after some events, each with the GID of its publisher."""
    made = ParameterChanges(lambda: TYPES, "then")
    for payload, gid in events:
        made.take(payload, gid)
    return {(one.node, one.name): one for one in made.heard().changed}


def test_a_change_is_told_with_the_value_of_the_start_where_it_was_heard():
    found = changes_of(
        (event("/a", new={"gain": 1, "rate": 5}), FIRST),
        (event("/a", changed={"gain": 2}), FIRST),
        (event("/a", changed={"gain": 3}), FIRST),
        (event("/b", changed={"gain": 4}), SECOND),
    )
    assert found == {
        ("/a", "gain"): ChangedParameter("/a", "gain", "3", "1", FIRST),
        ("/b", "gain"): ChangedParameter("/b", "gain", "4", None, SECOND),
    }


def test_what_was_set_back_deleted_or_started_anew_is_not_changed():
    begin = event("/a", new={"gain": 1}), FIRST
    change = event("/a", changed={"gain": 2}), FIRST
    assert changes_of(begin, change)
    assert changes_of(begin, change, (event("/a", changed={"gain": 1}), FIRST)) == {}
    assert changes_of(begin, change, (event("/a", deleted={"gain": 2}), FIRST)) == {}
    assert changes_of(begin, change, (event("/a", new={"gain": 1}), SECOND)) == {}


def test_another_system_begins_with_nothing():
    made = ParameterChanges(lambda: TYPES, "then")
    made.take(event("/a", changed={"gain": 2}), FIRST)
    made.read()
    made.forget()
    assert made.heard().changed == ()
    made.take(event("/a", changed={"gain": 3}), FIRST)
    assert [one.value for one in made.heard().changed] == ["3"]


def test_nodes_names_and_bytes_are_bounded():
    made = ParameterChanges(lambda: TYPES, "then")
    many = event("/many", changed={f"p{at}": at for at in range(1_500)})
    made.take(many, FIRST)
    assert len(made.heard().changed) == 200
    for at in range(6_000):
        made.take(event(f"/n{at}", changed={"x": 1}), FIRST)
        if at % 1_000 == 0:
            made.read()
    found = made.heard().changed
    assert (len(found), found[-1].node) == (200, "/n5999")
    made.take(b"\0\1\0\0broken", FIRST)
    made.take(b"x" * 2_000_000, FIRST)
    assert len(made.heard().changed) == 200
