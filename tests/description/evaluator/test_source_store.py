"""One open for all files of a description: rooted, edited in memory, kept until told."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

import pytest

from studio.description.evaluator.source_store import SourceStore
from studio.description.faults import Fault, Refusal
from studio.description.values import Edit
from studio.errors import EditError
from studio.packages.roots import ServedRoots
from tests.support.descriptions import write

if TYPE_CHECKING:
    from pathlib import Path


def store_of(folder: Path, overlay: dict[str, bytes] | None = None) -> SourceStore:
    return SourceStore(ServedRoots([folder]), overlay or {})


def test_a_tree_is_parsed_once_and_again_after_an_edit(tmp_path: Path):
    file = str(write(tmp_path, {"a.xacro": "<a/>"}))
    store = store_of(tmp_path)
    tree = store.tree(file)
    assert store.tree(file) is tree
    store.edit([Edit(file, 1, 2, b"b")])
    assert store.tree(file).root.tag == "b"


def test_edits_are_all_made_or_none(tmp_path: Path):
    file = str(write(tmp_path, {"a.xacro": "<a/>"}))
    store = store_of(tmp_path)
    store.tree(file)
    with pytest.raises(EditError, match="no bytes 3 to 99"):
        store.edit([Edit(file, 1, 2, b"b"), Edit(file, 3, 99, b"")])
    assert store.tree(file).root.tag == "a"


def test_a_file_that_was_never_read_cannot_be_edited(tmp_path: Path):
    file = str(write(tmp_path, {"a.xacro": "<a/>"}))
    with pytest.raises(EditError):
        store_of(tmp_path).edit([Edit(file, 0, 0, b"")])


def test_the_disk_is_looked_at_again_only_when_told(tmp_path: Path):
    file = str(write(tmp_path, {"a.xacro": "<a/>"}))
    store = store_of(tmp_path)
    store.tree(file)
    write(tmp_path, {"a.xacro": "<b/>"})
    assert store.tree(file).root.tag == "a"
    store.reload([file], {})
    assert store.tree(file).root.tag == "b"
    store.reload([file], {file: b"<c/>"})
    assert store.tree(file).root.tag == "c"


def test_a_file_that_was_missing_is_found_when_it_comes(tmp_path: Path):
    store, file = store_of(tmp_path), str(tmp_path / "a.xacro")
    with pytest.raises(Fault) as missing:
        store.tree(file)
    assert missing.value.unreadable
    assert list(store.asked) == [file]
    write(tmp_path, {"a.xacro": "<a/>"})
    assert store.tree(file).root.tag == "a"


def test_nothing_outside_the_roots_is_read_edited_or_laid_over(tmp_path: Path):
    outside = str(write(tmp_path, {"outside.xacro": "<a/>"}))
    inside = tmp_path / "inside"
    inside.mkdir()
    with pytest.raises(Refusal):
        store_of(inside).tree(outside)
    with pytest.raises(Refusal):
        store_of(inside).edit([Edit(outside, 0, 0, b"")])
    with pytest.raises(Refusal):
        store_of(inside, {outside: b"<b/>"})
    with pytest.raises(Refusal):
        store_of(inside).glob(str(tmp_path / "*"))


def test_patterns_match_sorted_files(tmp_path: Path):
    write(tmp_path, {"b.x": "", "a.x": "", "c.y": ""})
    (tmp_path / os.fsdecode(b"no text \xff.x")).touch()
    assert store_of(tmp_path).glob(f"{tmp_path}/*.x") == [f"{tmp_path}/{n}.x" for n in "ab"]
