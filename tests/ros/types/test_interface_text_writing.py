from __future__ import annotations

import pytest

from studio.ros.types.definitions import Interface, messages_of
from studio.ros.types.interface_text import kind_of, parse_interface, text_of
from studio.ros.types.library import TypeLibrary
from tests.support.sweep import some_of

LIBRARY = TypeLibrary("jazzy")


def bare(interface: Interface) -> list[object]:
    return [
        (
            [(field.name, field.type, field.default) for field in message.fields],
            [(one.name, one.base, one.value) for one in message.constants],
        )
        for message in messages_of(interface)
    ]


@pytest.mark.parametrize("name", some_of(LIBRARY.names()))
def test_every_type_reads_back_as_it_was_written(name: str):
    interface = LIBRARY.interface(name)
    again = parse_interface(name, text_of(interface))
    assert bare(again) == bare(interface)
    assert kind_of(again) == name.split("/")[1]


def test_odd_words_read_back_too():
    text = 'string a "x # \\"y\\\\"\nstring[] b ["p, q", "\'"]\nstring W=" z "\nfloat64 c 1e300'
    interface = parse_interface("p/msg/Odd", text)
    assert bare(parse_interface("p/msg/Odd", text_of(interface))) == bare(interface)
