from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.support.command_line import studio
from tests.support.demos import running_demo
from tests.support.wire import wait_until

if TYPE_CHECKING:
    from collections.abc import Generator

NODE = "/lc_talker"


@pytest.fixture(scope="module", autouse=True)
def talker(endpoint: str) -> Generator[None]:
    with running_demo(endpoint, "lifecycle_talker"):
        wait_until(
            "the node", lambda: NODE in studio("lifecycle", "nodes", "--connect", endpoint).out
        )
        yield


def test_l1_a_managed_node_walks_the_primary_states(endpoint: str):
    at = ("--connect", endpoint)
    assert studio("lifecycle", "nodes", *at).out == f"{NODE}\n"
    assert studio("lifecycle", "get", *at).out == f"{NODE}: unconfigured [1]\n"
    assert studio("lifecycle", "list", NODE, *at).out.startswith(
        "- configure [1]\n\tStart: unconfigured\n\tGoal: configuring\n"
    )
    for transition, state in (
        ("configure", "inactive [2]"),
        ("activate", "active [3]"),
        ("4", "inactive [2]"),
        ("cleanup", "unconfigured [1]"),
        ("shutdown", "finalized [4]"),
    ):
        ran = studio("lifecycle", "set", NODE, transition, *at)
        assert (ran.code, ran.out) == (0, "Transitioning successful\n")
        assert studio("lifecycle", "get", NODE, *at).out == f"{state}\n"


def test_an_unknown_transition_names_those_that_there_are(endpoint: str):
    ran = studio("lifecycle", "set", NODE, "dance", "--connect", endpoint)
    assert (ran.code, ran.out) == (1, "")
    assert ran.err.startswith("Unknown transition requested, available ones are:")


@pytest.mark.parametrize("words", [("get", "/no"), ("list", "/no"), ("set", "/no", "configure")])
def test_a_node_that_is_not_there(endpoint: str, words: tuple[str, ...]):
    ran = studio("lifecycle", *words, "--connect", endpoint)
    assert (ran.code, ran.err) == (1, "Node not found\n")
