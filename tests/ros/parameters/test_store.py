from __future__ import annotations

from threading import Thread

import pytest

from studio.errors import (
    InvalidParameterTypeError,
    InvalidParameterValueError,
    ParameterAlreadyDeclaredError,
    ParameterImmutableError,
    ParameterNotDeclaredError,
    ParameterUninitializedError,
)
from studio.ros.parameters.parameter import Parameter, usual_messages
from studio.ros.parameters.store import ParameterChange, ParameterStore
from studio.ros.types.library import TypeLibrary

RESULT = usual_messages().SetParametersResult
DESCRIPTOR = usual_messages().ParameterDescriptor
SPAN = TypeLibrary("jazzy").message("rcl_interfaces/msg/IntegerRange")


class Watched:
    """A store and what it told."""

    def __init__(self, **overrides: object) -> None:
        self.told: list[ParameterChange] = []
        given = {name: Parameter(name, value=value) for name, value in overrides.items()}
        self.store = ParameterStore(self.told.append, overrides=given)


def test_a_declared_parameter_is_read_and_told():
    watched = Watched()
    watched.store.declare("speed", 1.0)
    assert watched.store.get("speed").value == 1.0
    assert watched.told == [ParameterChange(new=(Parameter("speed", value=1.0),))]


def test_a_value_given_at_the_start_comes_before_the_one_in_the_code():
    store = Watched(speed=2.5).store
    assert store.declare("speed", 1.0).value == 2.5
    assert Watched(speed=2.5).store.declare("speed", 1.0, ignore_override=True).value == 1.0


def test_a_value_given_at_the_start_has_the_type_of_the_parameter():
    with pytest.raises(InvalidParameterTypeError, match="it is double, integer was given"):
        Watched(speed=2).store.declare("speed", 1.0)


def test_a_parameter_is_declared_once():
    store = Watched().store
    store.declare("a", 1)
    with pytest.raises(ParameterAlreadyDeclaredError, match='"a"'):
        store.declare("a", 2)


def test_what_is_not_declared_is_neither_read_nor_set():
    store = Watched().store
    for ask in (store.get, store.describe, store.undeclare):
        with pytest.raises(ParameterNotDeclaredError):
            ask("a")
    with pytest.raises(ParameterNotDeclaredError):
        store.set([Parameter("a", value=1)])


def test_a_parameter_keeps_its_type():
    store = Watched().store
    store.declare("a", 1)
    [result] = store.set([Parameter("a", value=1.5)])
    assert not result.successful
    assert "it is integer, double was given" in result.reason
    assert store.get("a").value == 1


def test_a_parameter_without_a_type_takes_any():
    watched = Watched()
    watched.store.declare("a")
    for value in (1, "x", [1.5]):
        assert watched.store.set([Parameter("a", value=value)])[0].successful
        assert watched.store.describe("a").type == Parameter("a", value=value).type_
    assert watched.store.set([Parameter("a")])[0].successful
    assert watched.told[-1] == ParameterChange(deleted=(Parameter("a"),))
    assert not watched.store.has("a")


def test_a_parameter_of_a_type_alone_waits_for_its_value():
    watched = Watched()
    watched.store.declare("a", Parameter.Type.STRING)
    with pytest.raises(ParameterUninitializedError):
        watched.store.get("a")
    assert not watched.store.set([Parameter("a", value=1)])[0].successful
    assert watched.store.set([Parameter("a", value="x")])[0].successful
    assert watched.told[-1] == ParameterChange(new=(Parameter("a", value="x"),))


def test_a_range_is_kept_from_the_first_value_on():
    span = DESCRIPTOR(integer_range=[SPAN(from_value=0, to_value=255, step=1)])
    store = Watched().store
    with pytest.raises(InvalidParameterValueError, match="Min: 0, Max: 255, value: 300"):
        store.declare("red", 300, span)
    store.declare("red", 3, span)
    [result] = store.set([Parameter("red", value=256)])
    assert result.reason == "Parameter red out of range. Min: 0, Max: 255, value: 256"


def test_a_parameter_may_be_given_another_range_and_a_value_that_fits():
    watched = Watched()
    watched.store.declare("red", 300)
    span = DESCRIPTOR(integer_range=[SPAN(from_value=0, to_value=255, step=1)])
    with pytest.raises(InvalidParameterValueError, match="Min: 0, Max: 255, value: 300"):
        watched.store.redescribe("red", span)
    assert watched.store.redescribe("red", span, 255) == 255
    assert watched.told[-1] == ParameterChange(changed=(Parameter("red", value=255),))
    assert not watched.store.set([Parameter("red", value=256)])[0].successful
    assert watched.store.redescribe("red", DESCRIPTOR(read_only=True)) == 255
    with pytest.raises(ParameterImmutableError):
        watched.store.redescribe("red", span)
    with pytest.raises(ParameterNotDeclaredError):
        watched.store.redescribe("blue", span)


def test_the_descriptor_that_was_given_stays_as_it_was():
    given = DESCRIPTOR(description="how fast", name="other")
    store = Watched().store
    store.declare("a", 1, given)
    assert given == DESCRIPTOR(description="how fast", name="other")
    assert store.describe("a") == DESCRIPTOR(name="a", type=2, description="how fast")


def test_what_may_only_be_read_is_neither_set_nor_taken_away():
    store = Watched().store
    store.declare("a", 1, DESCRIPTOR(read_only=True))
    assert "read-only" in store.set([Parameter("a", value=2)])[0].reason
    with pytest.raises(ParameterImmutableError):
        store.undeclare("a")


def test_a_parameter_taken_away_is_told_and_may_be_declared_again():
    watched = Watched()
    watched.store.declare("a", 1)
    watched.store.undeclare("a")
    assert watched.told[-1] == ParameterChange(deleted=(Parameter("a"),))
    watched.store.declare("a", "now a text")


def test_all_are_set_or_none():
    watched = Watched()
    watched.store.declare("a", 1)
    watched.store.declare("b", 1)
    told = len(watched.told)
    result = watched.store.set_atomically([Parameter("a", value=2), Parameter("b", value="x")])
    assert not result.successful
    assert (watched.store.get("a").value, len(watched.told)) == (1, told)
    both = [Parameter("a", value=2), Parameter("b", value=3)]
    assert watched.store.set_atomically(both).successful
    assert watched.told[-1] == ParameterChange(changed=tuple(both))


def test_a_refused_one_hinders_no_other():
    store = Watched().store
    store.declare("a", 1)
    store.declare("b", 1)
    results = store.set([Parameter("a", value="x"), Parameter("b", value=2)])
    assert [one.successful for one in results] == [False, True]
    assert store.get("b").value == 2


def test_a_callback_refuses_with_its_reason():
    watched = Watched()
    watched.store.declare("speed", 1.0)
    watched.store.callbacks.on_set.append(lambda _: RESULT(successful=False, reason="too fast"))
    result = watched.store.set_atomically([Parameter("speed", value=9.0)])
    assert result == RESULT(successful=False, reason="too fast")
    assert watched.store.get("speed").value == 1.0
    with pytest.raises(InvalidParameterValueError, match="too fast"):
        watched.store.declare("other", 1)
    assert not watched.store.has("other")


def test_a_callback_may_read_and_set_others():
    store = Watched().store
    store.declare("a", 1)
    store.declare("b", 1)

    def follow(given: list[Parameter]) -> object:
        if given[0].name == "a":
            store.set([Parameter("b", value=store.get("b").value + given[0].value)])
        return RESULT(successful=True)

    store.callbacks.on_set.append(follow)
    store.set([Parameter("a", value=5)])
    assert (store.get("a").value, store.get("b").value) == (5, 6)


def test_another_thread_may_read_while_a_callback_decides():
    store = Watched().store
    store.declare("a", 1)
    read: list[object] = []

    def wait_for_reader(_: list[Parameter]) -> object:
        reader = Thread(target=lambda: read.extend([store.get("a").value, *store.all()]))
        reader.start()
        reader.join(timeout=10)
        return RESULT(successful=True)

    store.callbacks.on_set.append(wait_for_reader)
    assert store.set([Parameter("a", value=2)])[0].successful
    assert read == [1, "a"]


def test_a_node_may_take_parameters_that_it_never_declared():
    told: list[ParameterChange] = []
    store = ParameterStore(told.append, allow_undeclared=True)
    assert store.get("a").type_ is Parameter.Type.NOT_SET
    assert store.set([Parameter("a", value=1)])[0].successful
    assert told == [ParameterChange(new=(Parameter("a", value=1),))]
    assert list(store.all()) == ["a"]
    store.set([Parameter("a")])
    assert told[-1] == ParameterChange(deleted=(Parameter("a"),))


def test_a_parameter_that_a_request_takes_away_twice_is_told_once():
    told: list[ParameterChange] = []
    store = ParameterStore(told.append, allow_undeclared=True)
    store.set_atomically([Parameter("x", value=1)])
    assert store.set_atomically([Parameter("x"), Parameter("x")]).successful
    assert not store.has("x")
    assert told[-1] == ParameterChange(deleted=(Parameter("x"),))


def test_a_typed_parameter_needs_a_value_or_a_type():
    with pytest.raises(InvalidParameterTypeError, match="dynamic_typing"):
        Watched().store.declare("a", None, DESCRIPTOR())


def test_a_parameter_needs_a_name():
    with pytest.raises(InvalidParameterValueError, match="1 to 1000 characters"):
        Watched().store.declare("", 1)
