from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.support.command_line import studio
from tests.support.told_recording import ToldRecording, written
from tests.support.written_bags import BEGIN_NS, some_messages, told_by_rosbags, write

if TYPE_CHECKING:
    from pathlib import Path

S = 1_000_000_000


@pytest.fixture
def bag(tmp_path: Path) -> Path:
    """Six seconds, in which the description is latched at the beginning and said once more."""
    told = some_messages()
    told[1] = ("/description", BEGIN_NS + 10_000_000, b"first")
    told[500] = ("/description", BEGIN_NS + 5 * S, b"second")
    write(tmp_path / "in", told)
    return tmp_path / "in"


def test_a_part_has_the_messages_between_two_times(bag: Path, tmp_path: Path):
    ran = studio("bag", "cut", str(bag), str(tmp_path / "out"), "--from", "2", "--to", "3")
    assert ran.code == 0, ran.err
    told, cut = told_by_rosbags(bag), told_by_rosbags(tmp_path / "out")
    within = [one for one in told if 2 * S <= one[1] - BEGIN_NS < 3 * S]
    assert cut == [("/description", BEGIN_NS + 2 * S, b"first"), *within]
    assert ran.out.startswith(f"{len(cut)} messages, ")


def test_what_is_latched_by_its_name_comes_first_where_a_bag_tells_no_quality(tmp_path: Path):
    recording = ToldRecording()
    recording.add_topic("/robot_description")
    recording.add_topic("/words")
    recording.tell("/robot_description", 0, data="<robot/>")
    for at in range(100):
        recording.tell("/words", at * 10, data=str(at))
    written(recording, tmp_path / "in")
    ran = studio("bag", "cut", str(tmp_path / "in"), str(tmp_path / "out"), "--from", "0.5")
    assert ran.code == 0, ran.err
    cut = told_by_rosbags(tmp_path / "out")
    assert cut[0][:2] == ("/robot_description", BEGIN_NS + S // 2)
    assert [topic for topic, _, _ in cut[1:]] == ["/words"] * 50


def test_times_may_be_of_the_clock_and_topics_be_chosen(bag: Path, tmp_path: Path):
    words = ("--from", str(BEGIN_NS / 1e9 + 4), "--topics", "/words", "description")
    assert studio("bag", "cut", str(bag), str(tmp_path / "out"), *words).code == 0
    cut = told_by_rosbags(tmp_path / "out")
    assert {topic for topic, _, _ in cut} == {"/words", "/description"}
    assert [data for topic, _, data in cut if topic == "/description"] == [b"first", b"second"]
    assert min(at_ns for _, at_ns, _ in cut) == BEGIN_NS + 4 * S


@pytest.mark.parametrize("words", [(), ("-s", "sqlite3"), ("--compression-mode", "file")])
def test_a_whole_bag_is_written_in_another_form(bag: Path, tmp_path: Path, words: tuple[str, ...]):
    assert studio("bag", "cut", str(bag), str(tmp_path / "out"), *words).code == 0
    assert told_by_rosbags(tmp_path / "out") == told_by_rosbags(bag)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--topics", "/nobody"), "It has no topic /nobody"),
        (("--from", "3", "--to", "2"), "give a later end"),
    ],
)
def test_what_cannot_be_cut_is_told_and_leaves_nothing(
    bag: Path, tmp_path: Path, words: tuple[str, ...], said: str
):
    ran = studio("bag", "cut", str(bag), str(tmp_path / "out"), *words)
    assert ran.code == 2
    assert said in ran.err
    assert not (tmp_path / "out").exists()


def test_what_is_there_is_not_written_over(bag: Path):
    ran = studio("bag", "cut", str(bag), str(bag))
    assert ran.code == 2
    assert "of that name already" in ran.err
    assert len(told_by_rosbags(bag)) == 600


def test_what_is_no_bag_is_told(tmp_path: Path):
    ran = studio("bag", "cut", str(tmp_path / "none"), str(tmp_path / "out"))
    assert ran.code == 2
    assert "it is not there" in ran.err
