from __future__ import annotations

import asyncio
import json
from typing import TYPE_CHECKING, Any

import pytest

from studio.errors import InvalidParameterTypeError, StudioError
from studio.live.panels.parameter_work import parameter_of
from studio.protocol.parameters import FollowParameters, GetParameters, LoadParameters, SetParameter
from studio.ros.parameters.parameter import Parameter
from tests.support.bridged import bridged
from tests.support.open_documents import until

if TYPE_CHECKING:
    from studio.ros.client import Node

pytestmark = pytest.mark.network


@pytest.mark.parametrize(
    ("text", "kind", "value"),
    [
        ("1", "double", 1.0),
        ("1e-3", "double", 0.001),
        ("[1, 2.5]", "double array", [1.0, 2.5]),
        ("true", "string", "true"),
        ("  two words ", "string", "  two words "),
        ("[7, 255]", "byte array", [b"\x07", b"\xff"]),
        ("[]", "string array", []),
        ("7", "integer", 7),
        ("7", "", 7),
        ("word", "", "word"),
    ],
)
def test_a_text_is_taken_as_its_parameter_wants_it(text: str, kind: str, value: object):
    assert parameter_of("x", text, kind).value == value


@pytest.mark.parametrize(
    ("text", "kind"),
    [
        ("x", "double"),
        ("1.5", "integer"),
        ("[1, x]", "integer array"),
        ("[", "bool"),
        ("256", "byte array"),
    ],
)
def test_what_a_parameter_cannot_be_is_refused(text: str, kind: str):
    with pytest.raises(InvalidParameterTypeError, match="x"):
        parameter_of("x", text, kind)


def test_all_types_are_told_and_large_numbers_are_not_lost(endpoint: str, tester: Node):
    values: dict[str, Any] = {
        "big": 2**60 + 1,
        "bytes": [b"\x01", b"\xff"],
        "doubles": [0.5, float("inf")],
        "text": "äöü",
        "truth": [True, False],
    }
    for name, value in values.items():
        tester.declare_parameter(name, value)

    async def run() -> None:
        async with bridged(endpoint) as page:
            told = await page.do(GetParameters(node="/tester"))
            by_name = {one.name: (one.value_type, json.loads(one.value)) for one in told.parameters}
            assert by_name["big"] == ("integer", str(2**60 + 1))
            assert by_name["bytes"] == ("byte array", [1, 255])
            assert by_name["doubles"] == ("double array", [0.5, "inf"])
            assert (by_name["text"][1], by_name["truth"][1]) == ("äöü", [True, False])

    asyncio.run(run())


def test_a_change_by_somebody_else_is_told_to_who_follows_the_node(endpoint: str, tester: Node):
    tester.declare_parameter("speed", 1.0)

    async def run() -> None:
        async with bridged(endpoint) as page:
            await page.do(FollowParameters(node="tester"))

            def told() -> bool:
                tester.set_parameters([Parameter("speed", value=2.5)])
                events = [one for one in page.ear.events if one["type"] == "parameters_changed"]
                return any(
                    (one["name"], one["value"]) == ("speed", "2.5")
                    for event in events
                    for one in event["parameters"]
                )

            await until(told)
            await page.do(FollowParameters())
            count = len(page.ear.events)
            tester.set_parameters([Parameter("speed", value=3.0)])
            await page.do(GetParameters(node="tester"))
            assert len(page.ear.events) == count

    asyncio.run(run())


def test_a_node_that_is_not_there_and_a_file_of_another_node_are_said_to_be_so(
    endpoint: str, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr("studio.live.panels.parameter_work.SERVER_PATIENCE_S", 0.1)

    async def run() -> None:
        async with bridged(endpoint) as page:
            with pytest.raises(StudioError, match="No node serves the service /nobody"):
                await page.do(SetParameter(node="/nobody", name="x", text="1"))
            other = "/other:\n  ros__parameters:\n    x: 1\n"
            with pytest.raises(StudioError, match="says nothing of /tester"):
                await page.do(LoadParameters(node="/tester", text=other))
            for text in ("[", "just words", "x: 1"):
                with pytest.raises(StudioError, match="The text"):
                    await page.do(LoadParameters(node="/tester", text=text))

    asyncio.run(run())
