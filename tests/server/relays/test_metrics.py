"""What a relay tells Prometheus, of a real studio that dialled in."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, NamedTuple

import httpx2
import pytest

from studio.server.relays.metrics import metrics
from tests.support.classmates import Classmate
from tests.support.nginx import free_port
from tests.support.relay import running_relay
from tests.support.server import RunningStudio, running_studio
from tests.support.studio_page import wait_until

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from studio.server.relays.room import Room
    from tests.support.relay import RunningRelay

LINE = re.compile(
    r"(?P<name>[a-zA-Z_:][a-zA-Z0-9_:]*)"
    r"(?P<labels>\{[a-zA-Z_][a-zA-Z0-9_]*=\"[^\"\\\n]*\"\})? "
    r"(?P<value>[+-]?(\d+(\.\d*)?([eE][+-]?\d+)?|Inf|NaN))"
)
"""A sample as the text format 0.0.4 has it, with one label at most."""
KINDS = {"counter", "gauge"}
Samples = dict[tuple[str, str], float]


def read(text: str) -> tuple[Samples, dict[str, str]]:
    """All samples by name and labels, and the kind of each name; every line is one or says one."""
    samples: Samples = {}
    kinds: dict[str, str] = {}
    helped: list[str] = []
    assert text.endswith("\n")
    for line in text.splitlines():
        if line.startswith("# HELP "):
            helped.append(line.split(" ", 3)[2])
        elif line.startswith("# TYPE "):
            _, _, name, kind = line.split(" ")
            assert helped[-1] == name
            assert name not in kinds
            kinds[name] = kind
        else:
            found = LINE.fullmatch(line)
            assert found, line
            assert found["name"] == helped[-1]
            key = found["name"], found["labels"] or ""
            assert key not in samples
            samples[key] = float(found["value"])
    assert set(kinds) == set(helped)
    assert set(kinds.values()) <= KINDS
    return samples, kinds


class Watched(NamedTuple):
    """A studio at a relay."""

    relay: RunningRelay
    origin: RunningStudio

    def ask(self) -> Samples:
        """All samples of now, by HTTP."""
        answer = httpx2.get(
            f"{self.relay.address}metrics",
            headers={"authorization": f"Bearer {self.relay.key}"},
            trust_env=False,
        )
        assert answer.status_code == 200
        assert answer.headers["content-type"].startswith("text/plain; version=0.0.4")
        samples, kinds = read(answer.text)
        for (name, _), value in samples.items():
            if kinds[name] == "counter":
                assert name.endswith("_total")
                assert value >= 0
        return samples

    def value(self, name: str) -> float:
        """Of the one room."""
        return next(
            (value for (one, _), value in self.ask().items() if one == f"studio_relay_{name}"), -1
        )

    def becomes(self, name: str, wanted: float) -> None:
        wait_until(f"{name} to be {wanted}", lambda: self.value(name) == wanted)


@pytest.fixture(scope="module")
def watched(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Watched]:
    folder = tmp_path_factory.mktemp("metrics")
    words = ["--listen", f"tls/127.0.0.1:{free_port()}", "--port", "0"]
    with running_relay(words, folder / "relay") as relay:
        shared = ["demo", "--share", "--host", "127.0.0.1", "--via", relay.line]
        with running_studio(shared, folder / "origin") as origin:
            yield Watched(relay, origin)


@pytest.mark.network
def test_counters_only_grow_while_people_come_and_go(watched: Watched):
    watched.becomes("origin_up", 1)
    assert watched.value("rooms") == 1
    ((_, labels),) = (one for one in watched.ask() if one[0] == "studio_relay_pages")
    room = labels.split('"')[1]
    before = watched.ask()
    ada = Classmate(f"{watched.relay.address}{room}/")
    try:
        assert ada.join("Ada", watched.origin.class_code).status_code == 303
        with ada.lane() as lane, ada.lane() as second:
            for one in (lane, second):
                one.until("you", name="Ada")
            watched.becomes("pages", 2)
            watched.becomes("people", 1)
            lane.ask("watch", document="rover")
            meanwhile = watched.ask()
    finally:
        ada.close()
    watched.becomes("pages", 0)
    watched.becomes("people", 0)
    after = watched.ask()
    counters = [one for one in before if one[0].endswith("_total")]
    assert len(counters) == 5
    for one in counters:
        assert before[one] <= meanwhile[one] <= after[one], one
        if "refused" not in one[0]:
            assert before[one] < after[one], one
        else:
            assert after[one] == 0


@pytest.mark.network
def test_what_was_counted_stays_when_the_studio_goes(watched: Watched):
    """Last of all: the studio is ended."""
    watched.becomes("origin_up", 1)
    before = watched.ask()
    watched.origin.stop()
    watched.becomes("origin_up", 0)
    after = watched.ask()
    assert set(after) == set(before)
    for (name, labels), value in before.items():
        if name.endswith("_total"):
            assert after[name, labels] >= value, name


def test_a_relay_without_rooms_says_so():
    class Empty:
        rooms: Mapping[str, Room] = {}
        crowd = None

    samples, kinds = read(metrics(Empty()))
    assert samples == {
        ("studio_relay_rooms", ""): 0,
        ("studio_relay_browser_bytes_total", ""): 0,
    }
    assert len(kinds) == 10
