"""The course's rows on calls, goals, parameters and publishing, as panels do them by the bridge."""

from __future__ import annotations

import asyncio
import json
from typing import TYPE_CHECKING, Any

import pytest

from studio.errors import CommandError
from studio.protocol.calls import CallService, CancelCall, GetActions, GetServices
from studio.protocol.goals import CancelGoal, GetGoalStatuses, SendGoal
from studio.protocol.parameters import (
    DumpParameters,
    FollowParameters,
    GetParameterNodes,
    GetParameters,
    LoadParameters,
    SetParameter,
)
from studio.protocol.publishing import Publish, StopPublishing
from tests.support.bridged import Bridged, bridged
from tests.support.demos import heard, node_at, running_demo
from tests.support.open_documents import until
from tests.support.wire import running_router

if TYPE_CHECKING:
    from collections.abc import Generator

    from studio.protocol import Command

pytestmark = [pytest.mark.network, pytest.mark.timeout(120)]
SONG = "radio_station_interfaces/action/ChooseSong"
TWIST = "geometry_msgs/msg/Twist"
FAST = ("--ros-args", "-p", "step_seconds:=0.02")
SLOW = ("--ros-args", "-p", "step_seconds:=5.0")


@pytest.fixture(scope="module")
def router() -> Generator[str]:
    with running_router() as endpoint:
        yield endpoint


async def offered(page: Bridged, command: Command, name: str) -> None:
    """Wait until a service, an action or a node is listed."""

    async def names() -> list[str]:
        told = await page.do(command)
        rows = next(value for field, value in told if field in {"services", "actions", "nodes"})
        return [getattr(one, "name", one) for one in rows]

    while name not in await names():  # noqa: ASYNC110 - nothing tells us when
        await asyncio.sleep(0.02)


async def called(page: Bridged, name: str, kind: str, text: str = "") -> Any:  # noqa: ANN401
    await offered(page, GetServices(), name)
    number = await page.begin(CallService(name=name, service_type=kind, text=text, timeout_s=60))
    told = await page.operation_in("calls", number, "answered", "failed")
    assert told["state"] == "answered", told["trouble"]
    return json.loads(told["reply"])


def test_sv1_the_radio_stations_reply_has_its_three_strings(router: str):
    async def run() -> None:
        async with bridged(router) as page:
            kind = "radio_station_interfaces/srv/GetNowPlaying"
            reply = await called(page, "/get_now_playing", kind)
            assert reply["song_title"] == "Bohemian Rhapsody"
            assert set(reply) == {"station_name", "song_title", "artist_name"}

    with running_demo(router, "service_server"):
        asyncio.run(run())


def test_sv2_the_slides_yaml_gives_42(router: str):
    async def run() -> None:
        async with bridged(router) as page:
            kind = "example_interfaces/srv/AddTwoInts"
            assert await called(page, "/add_two_ints", kind, "{a: 41, b: 1}") == {"sum": 42}

    with running_demo(router, "service_server_node"):
        asyncio.run(run())


def test_sv3_points_are_added_and_a_call_is_cancelled_while_others_go_on(router: str):
    kind = "pkg_with_interfaces/srv/AddPoints"
    text = "{a: {x: 1.0, y: 2.0}, b: {x: 0.5}}"

    async def run() -> None:
        async with bridged(router) as page:
            reply = await called(page, "/add_points", kind, text)
            assert reply == {"result": {"x": 1.5, "y": 2.0, "z": 0.0}}
            waiting = await page.begin(CallService(name="/nobody", service_type=kind))
            await page.do(CancelCall(operation=waiting))
            assert (await page.operation_in("calls", waiting, "cancelled"))["reply"] == ""
            assert await called(page, "/add_points", kind, text) == reply

    with running_demo(router, "add_points_server"):
        asyncio.run(run())


async def sent(page: Bridged, song: str) -> int:
    await offered(page, GetActions(), "/choose_song")
    goal = SendGoal(name="/choose_song", action_type=SONG, text=f"{{song_name: {song}}}")
    return await page.begin(goal.model_copy(update={"timeout_s": 60.0}))


def feedback_of(page: Bridged, number: int) -> list[dict[str, Any]]:
    """All feedback of a goal, as a page puts it together."""
    told = (one for one in page.ear.events if one["type"] == "goals")
    found = (
        operation
        for one in told
        for operation in one["operations"]
        if operation["operation"] == number
    )
    return [one for operation in found for one in operation["feedback"]]


def test_a1_a_song_gives_21_feedbacks_and_a_result(router: str):
    async def run() -> None:
        async with bridged(router) as page:
            number = await sent(page, "Clocks")
            told = await page.operation_in("goals", number, "succeeded", "failed")
            assert (told["state"], told["feedback_count"]) == ("succeeded", 21)
            heard_ones = feedback_of(page, number)
            assert [one["number"] for one in heard_ones] == list(range(1, 22))
            shares = [json.loads(one["values"])["progress_pct"] for one in heard_ones]
            assert shares == list(range(0, 101, 5))
            assert json.loads(told["result"]) == {
                "success": True,
                "final_message": "Finished Clocks",
            }

    with running_demo(router, "radio_dj", *FAST):
        asyncio.run(run())


def test_a2_of_several_goals_one_is_cancelled_and_one_is_refused(router: str):
    async def run() -> None:
        async with bridged(router) as page:
            first, second = await sent(page, "Clocks"), await sent(page, "Yellow")
            nameless = await sent(page, '""')
            await page.operation_in("goals", nameless, "rejected")
            for one in (first, second):
                await until(lambda one=one: bool(feedback_of(page, one)))
            await page.do(CancelGoal(operation=first))
            told = await page.operation_in("goals", first, "canceled", "failed")
            assert told["state"] == "canceled"
            assert json.loads(told["result"])["final_message"] == "Stopped Clocks"
            states: dict[str, str] = {}
            while states.get(told["goal_id"]) != "canceled":
                answer = await page.do(GetGoalStatuses(name="/choose_song"))
                states = {one.goal_id: one.state for one in answer.goals}
                assert all(one.is_ours for one in answer.goals)
                await asyncio.sleep(0.02)
            assert states[page.operation("goals", second)["goal_id"]] == "executing"
            await page.do(CancelGoal(operation=second))
            await page.operation_in("goals", second, "canceled")

    with running_demo(router, "radio_dj", *SLOW):
        asyncio.run(run())


def test_a_server_that_is_gone_ends_its_goals_with_a_sentence(router: str):
    async def run() -> None:
        async with bridged(router) as page:
            with running_demo(router, "radio_dj", *SLOW):
                number = await sent(page, "Clocks")
                await until(lambda: bool(feedback_of(page, number)))
            told = await page.operation_in("goals", number, "failed")
            assert "ended before the goal did" in told["trouble"]

    asyncio.run(run())


async def values_of(page: Bridged, node: str) -> dict[str, Any]:
    told = await page.do(GetParameters(node=node))
    return {one.name: json.loads(one.value) for one in told.parameters}


def test_p1_turtlesims_background_is_listed_set_written_down_and_loaded(router: str):
    async def run() -> None:
        async with bridged(router) as page:
            await offered(page, GetParameterNodes(), "/turtlesim")
            await page.do(FollowParameters(node="/turtlesim"))
            told = await page.do(GetParameters(node="turtlesim"))
            red = next(one for one in told.parameters if one.name == "background_r")
            assert (red.value_type, red.value, red.low, red.high) == ("integer", "69", 0, 255)
            ask = SetParameter(node="/turtlesim", name="background_r", text="200")
            await page.do(ask.model_copy(update={"value_type": red.value_type}))
            assert (await values_of(page, "/turtlesim"))["background_r"] == 200
            changed = {"name": "background_r", "value": "200"}
            await until(
                lambda: any(
                    changed.items() <= one.items()
                    for event in page.ear.events
                    if event["type"] == "parameters_changed"
                    for one in event["parameters"]
                )
            )
            written = (await page.do(DumpParameters(node="/turtlesim"))).text
            assert "background_r: 200" in written
            loaded = await page.do(
                LoadParameters(node="/turtlesim", text=written.replace("200", "7"))
            )
            assert loaded.count > 0
            assert (await values_of(page, "/turtlesim"))["background_r"] == 7

    with running_demo(router, "turtlesim_node"):
        asyncio.run(run())


def test_p2_a_set_that_is_refused_tells_the_nodes_reason(router: str):
    async def run() -> None:
        async with bridged(router) as page:
            await offered(page, GetParameterNodes(), "/turtlesim")
            for text, words in (("900", "Max: 255"), ("red", "integer")):
                ask = SetParameter(node="/turtlesim", name="background_r", text=text)
                with pytest.raises(CommandError, match=f"did not set background_r: .*{words}"):
                    await page.do(ask)
            assert (await values_of(page, "/turtlesim"))["background_r"] == 69

    with running_demo(router, "turtlesim_node"):
        asyncio.run(run())


def test_t2_the_slides_yaml_is_published_at_a_rate_until_it_is_stopped(router: str):
    text = "{linear: {x: 2.0, y: 0.0, z: 0.0}, angular: {x: 0.0, y: 0.0, z: 1.8}}"

    async def run() -> None:
        with node_at(router) as node:
            twists = heard(node, TWIST, "/turtle1/cmd_vel")
            async with bridged(router) as page:
                once = await page.begin(
                    Publish(name="/turtle1/cmd_vel", message_type=TWIST, text=text)
                )
                told = await page.operation_in("publications", once, "done", "failed")
                assert (told["state"], told["sent"]) == ("done", 1)
                await until(lambda: len(twists) == 1)
                ask = Publish(name="turtle1/cmd_vel", message_type=TWIST, text=text, rate_hz=50)
                number = await page.begin(ask)
                await until(lambda: len(twists) > 5)
                await page.do(StopPublishing(operation=number))
                told = await page.operation_in("publications", number, "stopped")
                assert told["sent"] >= 5
            assert {(one.linear.x, one.angular.z) for one in twists} == {(2.0, 1.8)}

    asyncio.run(run())
