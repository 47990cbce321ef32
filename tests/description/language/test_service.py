"""Every question gets an answer, whatever the text, and costs the robot nothing."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from studio.description.language.questions import (
    LANGUAGE_REPLIES,
    CompletionQuery,
    Completions,
    LookedUp,
    LookUpQuery,
    OutlineQuery,
    ReferencesQuery,
)
from studio.description.requests import CODEC
from studio.description.values import ArgumentsRequest, EditRequest, Expansion, NoReply
from tests.support.descriptions import robot, write
from tests.support.language import Editor, at, labels, pr2
from tests.support.questioned_robot import FILES
from tests.support.studio_page import wait_until
from tests.support.sweep import some_of

if TYPE_CHECKING:
    from pathlib import Path

    from studio.description.language.questions import LanguageQuery

PLACE_QUERIES = (LookUpQuery, ReferencesQuery, CompletionQuery)
BUDGET_S = 2.0
"""Many times what the slowest one takes, so that a busy machine fails nobody."""


@pytest.fixture
def editor(tmp_path: Path) -> Editor:
    return Editor(tmp_path, write(tmp_path, FILES))


def test_any_place_of_any_beginning_of_a_text_is_answered(editor: Editor):
    whole = {name: text for name, text in FILES.items() if name.endswith(("xacro", "yaml"))}

    @settings(suppress_health_check=[HealthCheck.too_slow], deadline=None, max_examples=150)
    @given(st.sampled_from(sorted(whole)), st.data())
    def asked(name: str, data: st.DataObject) -> None:
        text = whole[name]
        text = text if isinstance(text, str) else text.decode()
        cut = text[: data.draw(st.integers(0, len(text)))]
        cut += data.draw(
            st.sampled_from(["", "<", '"', "${", "$(", "<xacro:arm ", "\n</", "🤖", "'"])
        )
        before = cut[: data.draw(st.integers(0, len(cut)))]
        offset = len(before.encode("utf-16-le")) // 2
        for kind in PLACE_QUERIES:
            began = time.thread_time()
            reply = editor.ask(kind(str(editor.root / name), cut.encode(), offset))
            assert isinstance(reply, LANGUAGE_REPLIES), reply
            assert time.thread_time() - began < BUDGET_S

    asked()


@given(st.text(max_size=200), st.integers(0, 250))
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
def test_any_text_is_answered(tmp_path_factory: pytest.TempPathFactory, text: str, offset: int):
    folder = tmp_path_factory.mktemp("any")
    editor = Editor(folder, write(folder, {"a.xacro": robot("<link name='a'/>")}))
    data = text.encode("utf-8", "surrogatepass")
    for kind in PLACE_QUERIES:
        reply = editor.ask(kind(str(editor.entry), data, offset))
        is_refused = isinstance(reply, NoReply) and "no place" in reply.sentence
        assert is_refused or isinstance(reply, LANGUAGE_REPLIES), reply


@pytest.mark.parametrize(
    "text",
    some_of(
        [
            "<" * 300_000,
            "<!--" * 100_000,
            "<a " * 100_000,
            "<a b='" * 60_000,
            '<a b="${' + "(" * 200_000,
            "<a b='${" + "x." * 100_000 + "y}'/>",
            "<a b='${" + "x[" * 50_000,
            "<a b='" + "${x} " * 60_000 + "'/>",
            "<a>" * 100_000,
            "'\"" * 150_000,
            "<xacro:macro name='m' params='" + "a:= " * 50_000 + "'/>",
        ]
    ),
    ids=lambda text: str(text)[:12],
)
def test_a_text_made_to_be_slow_is_answered_all_the_same(tmp_path: Path, text: str):
    editor = Editor(tmp_path, write(tmp_path, {"a.xacro": robot("<link name='a'/>")}))
    for offset in (len(text), len(text) // 2):
        for kind in PLACE_QUERIES:
            began = time.thread_time()
            reply = editor.ask(kind(str(editor.entry), text.encode(), offset))
            assert isinstance(reply, LANGUAGE_REPLIES), reply
            assert time.thread_time() - began < BUDGET_S


def test_a_robot_that_never_ran_is_asked_too(tmp_path: Path):
    body = '<xacro:property name="a" value="1"/><link name="${a}"/><xacro:lost/>'
    editor = Editor(tmp_path, write(tmp_path, {"a.xacro": robot(body)}))
    assert editor.meaning(editor.entry, "${|a}").places[0].line == 1
    assert labels(editor.completions(editor.entry, "</robot>", "<link name='${a"))[0] == "a"


def test_an_edit_and_an_arg_are_followed(editor: Editor):
    assert editor.meaning(editor.entry, "$(arg ki|nd)").values == ("long",)
    data = editor.entry.read_bytes()
    start = data.index(b'"0.5"') + 1
    editor.type(editor.entry, start, start + 3, b"0.25")
    arm = editor.root / "urdf/arm.xacro"
    assert editor.meaning(arm, '"${length} ${rea|ch}').values == ("0.25",)
    editor.session.answer(ArgumentsRequest({"kind": "wide"}))
    assert editor.meaning(editor.entry, "$(arg ki|nd)").values == ("wide",)


def test_a_text_that_the_worker_has_not_yet_is_asked_as_it_is(editor: Editor):
    text = editor.entry.read_bytes()
    editor.texts[editor.entry] = text.replace(b'value="0.5"', b'value="0.75"')
    assert editor.meaning(editor.entry, 'name="rea|ch"').values == ("0.75",)


def test_while_the_text_is_broken_the_last_values_are_told_where_they_moved_to(editor: Editor):
    start = editor.entry.read_bytes().index(b"<xacro:arg")
    editor.type(editor.entry, start, start, "<löken \n".encode())
    assert not isinstance(editor.answer, Expansion)
    found = editor.meaning(editor.entry, '"0 ${len|gth} 0"')
    assert (found.values, at(found.places[0])) == (("7",), "robot.xacro:6")


def test_what_a_good_run_brought_is_offered_soon_while_typing_goes_on(editor: Editor):
    assert editor.completions(editor.entry, "</robot>", "<xacro:ar").items
    start = editor.entry.read_bytes().index(b"</robot>")
    other = robot('<xacro:macro name="brought" params="x"/>')
    write(editor.root, {"urdf/other.xacro": other})
    editor.type(editor.entry, start, start, b'<xacro:include filename="other.xacro"/>')
    assert isinstance(editor.answer, Expansion)

    def offered_now() -> bool:
        found = editor.completions(editor.entry, "</robot>", "<xacro:bro")
        return labels(found) == ["xacro:brought"]

    wait_until("the macro of the new include", offered_now, patience_s=10)


def test_questions_leave_no_trace_in_the_run(editor: Editor):
    before = editor.session.answer(EditRequest(()))
    editor.meaning(editor.entry, "sizes.ma|ss")
    editor.completions(editor.entry, "</robot>", "<xacro:include filename='../")
    editor.outline()
    after = editor.session.answer(EditRequest(()))
    assert isinstance(before, Expansion)
    assert isinstance(after, Expansion)
    assert (after.files, after.changed_parts, after.warnings) == (before.files, (), before.warnings)


@pytest.mark.parametrize("path", ["/etc/passwd", "/usr", "/proc/self/environ"])
def test_a_file_outside_the_roots_is_not_looked_into(editor: Editor, path: str):
    text = robot(f'<xacro:include filename="{path}"/>')
    reply = editor.ask(LookUpQuery(str(editor.entry), text.encode(), text.index(path) + 2))
    assert reply == LookedUp(None)


def test_an_offset_outside_of_the_text_is_refused_in_a_sentence(editor: Editor):
    reply = editor.ask(LookUpQuery(str(editor.entry), b"<a/>", 99))
    assert isinstance(reply, NoReply)
    assert reply.sentence.endswith("load it again.")


def test_questions_and_answers_cross_the_pipe(editor: Editor):
    text = editor.entry.read_bytes()
    queries: list[LanguageQuery] = [OutlineQuery()]
    queries += [kind(str(editor.entry), text, 400) for kind in PLACE_QUERIES]
    for query in queries:
        assert CODEC.unpack(CODEC.pack(query)[4:]) == query
        reply = editor.ask(query)
        assert CODEC.unpack(CODEC.pack(reply)[4:]) == reply


def test_pr2_is_looked_up_at_every_hundredth_place():
    editor = pr2()
    text = editor.entry.read_bytes()
    known = 0
    for offset in range(0, len(text), 100):
        reply = editor.ask(LookUpQuery(str(editor.entry), text, offset))
        assert isinstance(reply, LookedUp)
        known += reply.meaning is not None
        reply = editor.ask(CompletionQuery(str(editor.entry), text, offset))
        assert isinstance(reply, Completions)
    assert known > 10
