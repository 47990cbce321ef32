from __future__ import annotations

import argparse
import io
from itertools import islice
from typing import TYPE_CHECKING

import pytest

from studio.cli.commands.topic.pub import TEXT_BYTES_MAX, MessageSource, source_of
from studio.errors import MessageValueError, SettingsError
from studio.ros.messages import message

if TYPE_CHECKING:
    from pathlib import Path


def source(
    values: str = "{}", kind: str = "std_msgs/msg/String", *, stdin: bool = False,
    yaml_file: Path | None = None,
) -> MessageSource:  # fmt: skip
    options = argparse.Namespace(values=values, stdin=stdin, yaml_file=yaml_file)
    return source_of(options, message(kind))


def test_one_message_is_said_without_end():
    said = source("data: Hello")
    assert said.count is None
    assert [one.data for one in islice(said.messages, 3)] == ["Hello"] * 3


def test_a_header_tells_the_time_of_each_message():
    first, second = islice(source("header: auto", "geometry_msgs/msg/PointStamped").messages, 2)
    stamps = [(one.header.stamp.sec, one.header.stamp.nanosec) for one in (first, second)]
    assert stamps[0] < stamps[1]


def test_t2_the_messages_of_a_file_come_one_after_another(tmp_path: Path):
    file = tmp_path / "said.yaml"
    file.write_text("---\ndata: one\n--- # two\ndata: 'a --- b'\n---\n\n---\n{}\n---\n")
    said = source(yaml_file=file)
    assert said.count == 3
    assert [one.data for one in said.messages] == ["one", "a --- b", ""]


def test_a_text_that_is_no_yaml_is_named_by_where_it_came_from(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    file = tmp_path / "said.yaml"
    file.write_text("data: one\n---\n# two\ndata: [\n")
    monkeypatch.setattr("sys.stdin", io.StringIO("data: [1\n"))
    for made, said in (
        (lambda: source(yaml_file=file), rf"{file} is no YAML \(line 5, column 1: "),
        (lambda: source(stdin=True), r"standard input is no YAML \(line 2, column 1: "),
        (lambda: source("{data: ["), r"'\{data: \[' is no YAML \(line 1, column 9: "),
    ):
        with pytest.raises(MessageValueError, match=said):
            made()


def test_fields_are_read_from_standard_input(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr("sys.stdin", io.StringIO("data: piped\n"))
    assert next(source(stdin=True).messages).data == "piped"


@pytest.mark.parametrize("text", ["", "---\n---\n", "\n\n"])
def test_a_file_without_a_message_is_refused(tmp_path: Path, text: str):
    file = tmp_path / "empty.yaml"
    file.write_text(text)
    with pytest.raises(SettingsError, match="holds no message"):
        source(yaml_file=file)


def test_a_file_that_cannot_be_read_is_one_sentence(tmp_path: Path):
    with pytest.raises(SettingsError, match="cannot be read"):
        source(yaml_file=tmp_path / "none.yaml")
    with pytest.raises(SettingsError, match="cannot be read"):
        source(yaml_file=tmp_path)
    (tmp_path / "large.yaml").write_bytes(b" " * (TEXT_BYTES_MAX + 1))
    with pytest.raises(SettingsError, match="larger than"):
        source(yaml_file=tmp_path / "large.yaml")


def test_any_mistake_of_a_file_is_told_before_anything_is_said(tmp_path: Path):
    file = tmp_path / "said.yaml"
    file.write_text("data: one\n---\ndat: two\n")
    with pytest.raises(MessageValueError):
        source(yaml_file=file)
