"""A session answers what each request changed, and keeps the last good robot."""

from __future__ import annotations

import random
from contextlib import suppress
from itertools import pairwise
from pathlib import Path

import pytest

from studio.description.editing.edits import difference
from studio.description.evaluator.evaluation import Evaluation
from studio.description.faults import Unsupported
from studio.description.session import Session, open_session
from studio.description.values import (
    ArgumentsRequest,
    Edit,
    EditRequest,
    Expansion,
    Failure,
    OpenRequest,
    ReloadRequest,
)
from studio.errors import StaleEditError
from tests.support.descriptions import policy_for, robot, write
from tests.support.patched import SideBySide
from tests.support.sweep import some_of

MODELS = Path(__file__).resolve().parents[2] / "models"
BODY = (
    '<xacro:arg name="side" default="left"/><xacro:property name="r" value="0.1"/>'
    '<xacro:macro name="wheel" params="n"><link name="${n}"><visual><geometry>'
    '<sphere radius="${r}"/></geometry></visual></link></xacro:macro>'
    '<xacro:wheel n="a"/><xacro:wheel n="b"/><link name="$(arg side)"/>'
    '<joint name="j" type="fixed"/><gazebo/><gazebo/><material name="red"/>'
)


def opened(file: Path, **arguments: str) -> tuple[Session, Expansion]:
    session, answer = open_session(OpenRequest(str(file), arguments, policy_for(file.parent), {}))
    assert session is not None
    assert isinstance(answer, Expansion), answer
    return session, answer


def replace(file: Path, old: str, new: str, data: bytes | None = None) -> EditRequest:
    """Replace the one place of a text in the bytes of a file."""
    start = (data or file.read_bytes()).index(old.encode())
    return EditRequest((Edit(str(file), start, start + len(old), new.encode()),))


def changed(answer: object) -> list[str]:
    assert isinstance(answer, Expansion), answer
    return [part.key for part in answer.changed_parts]


def test_the_first_answer_holds_everything(tmp_path: Path):
    file = write(tmp_path, {"a.xacro": robot(BODY)})
    _, answer = opened(file)
    keys = ("link:a", "link:b", "link:left", "joint:j", "other:0", "other:1", "material:red")
    assert answer.part_order == keys
    assert changed(answer) == list(keys)
    assert answer.site_order is not None
    assert {site.id for site in answer.changed_sites} == set(answer.site_order)
    assert (answer.robot_name, answer.evaluator) == ("r", "studio")
    assert answer.files == (str(file),)
    first = answer.changed_parts[0]
    assert first.xml == (
        '<link name="a"><visual><geometry><sphere radius="0.1"/></geometry></visual></link>'
    )
    assert [call.macro for call in first.calls] == ["wheel"]


def test_an_edit_answers_only_what_it_changed(tmp_path: Path):
    file = write(tmp_path, {"a.xacro": robot(BODY)})
    session, _ = opened(file)
    answer = session.answer(replace(file, "0.1", "0.25"))
    assert changed(answer) == ["link:a", "link:b"]
    assert isinstance(answer, Expansion)
    assert (answer.part_order, answer.site_order) == (None, None)
    sites = {site.name: site for site in answer.changed_sites}
    assert sites["r"].text == "0.25"
    assert sites["r"].number == 0.25


def test_the_same_again_changes_nothing(tmp_path: Path):
    file = write(tmp_path, {"a.xacro": robot(BODY)})
    session, _ = opened(file)
    answer = session.answer(replace(file, "0.1", "0.1"))
    assert isinstance(answer, Expansion)
    assert (answer.changed_parts, answer.changed_sites) == ((), ())


def test_arguments_are_given_and_taken_back(tmp_path: Path):
    file = write(tmp_path, {"a.xacro": robot(BODY)})
    session, _ = opened(file, side="right")
    answer = session.answer(ArgumentsRequest({}))
    assert changed(answer) == ["link:left"]
    assert isinstance(answer, Expansion)
    assert answer.part_order is not None
    assert "link:right" not in answer.part_order


def test_a_broken_text_stays_and_the_last_good_parts_stand(tmp_path: Path):
    file = write(tmp_path, {"a.xacro": robot(BODY)})
    session, _ = opened(file)
    broken = session.answer(replace(file, "0.1", "${"))
    assert isinstance(broken, Failure)
    assert broken.files == (str(file),)
    text = file.read_bytes().replace(b"0.1", b"${")
    mended = session.answer(replace(file, "${", "0.3", text))
    assert changed(mended) == ["link:a", "link:b"]


def test_an_edit_outside_its_file_is_refused_and_leaves_the_text(tmp_path: Path):
    file = write(tmp_path, {"a.xacro": robot(BODY)})
    session, _ = opened(file)
    refused = session.answer(EditRequest((Edit(str(file), 5, 10**6, b"x"),)))
    assert isinstance(refused, Failure)
    assert refused.problem.code == "edit-refused"
    assert changed(session.answer(ArgumentsRequest({}))) == []


def test_a_changed_file_is_taken_from_disk_when_told(tmp_path: Path):
    file = write(
        tmp_path,
        {"a.xacro": robot('<xacro:include filename="b.xacro"/>'), "b.xacro": robot("<x/>", "")},
    )
    session, answer = opened(file)
    inner = str(tmp_path / "b.xacro")
    assert answer.include_tree == ((str(file), inner),)
    write(tmp_path, {"b.xacro": robot("<y/>", "")})
    assert changed(session.answer(ArgumentsRequest({}))) == []
    assert changed(session.answer(ReloadRequest((inner,), {}))) == ["other:0"]


def test_a_missing_file_is_among_those_to_watch(tmp_path: Path):
    file = write(tmp_path, {"a.xacro": robot('<xacro:include filename="b.xacro"/>')})
    session, failure = open_session(OpenRequest(str(file), {}, policy_for(tmp_path), {}))
    assert isinstance(failure, Failure)
    assert failure.files == (str(file), str(tmp_path / "b.xacro"))
    write(tmp_path, {"b.xacro": robot("<x/>", "")})
    assert session is not None
    assert changed(session.answer(ReloadRequest((failure.files[1],), {}))) == ["other:0"]


def test_unsaved_texts_are_opened_instead_of_those_on_disk(tmp_path: Path):
    file = write(tmp_path, {"a.xacro": robot("<x/>")})
    overlay = {str(file): robot("<y/>").encode()}
    _, answer = open_session(OpenRequest(str(file), {}, policy_for(tmp_path), overlay))
    assert isinstance(answer, Expansion)
    assert answer.changed_parts[0].xml == "<y/>"


def test_a_linked_file_is_known_by_its_target(tmp_path: Path):
    file = write(
        tmp_path,
        {"a.xacro": robot('<xacro:include filename="l.xacro"/>'), "b.xacro": robot("<x/>", "")},
    )
    (tmp_path / "l.xacro").symlink_to(tmp_path / "b.xacro")
    _, answer = opened(file)
    assert answer.files[1] == str(tmp_path / "b.xacro")


def test_a_missing_package_offers_to_choose_its_folder(tmp_path: Path):
    file = write(tmp_path, {"a.xacro": robot('<xacro:include filename="$(find p)/b"/>')})
    _, failure = open_session(OpenRequest(str(file), {}, policy_for(tmp_path), {}))
    assert isinstance(failure, Failure)
    assert failure.problem.fix is not None
    assert (failure.problem.fix.action, failure.problem.fix.target) == ("choose_package", "p")


def test_a_yaml_value_is_edited_like_a_property(tmp_path: Path):
    file = write(
        tmp_path,
        {
            "a.xacro": robot(
                """<xacro:property name="c" value="${xacro.load_yaml('c.yaml')}"/>
                <link name="${c['arm']['name']}"/><link name="other"/>"""
            ),
            "c.yaml": "arm:\n  name: first\n",
        },
    )
    session, answer = opened(file)
    site = next(site for site in answer.changed_sites if site.name == "arm.name")
    assert site.reads == 1
    answer = session.answer(replace(tmp_path / "c.yaml", "first", "second"))
    assert changed(answer) == ["link:second"]


def test_what_our_evaluator_does_not_know_stock_expands(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    def unknown(_self: Evaluation, _entry: str) -> None:
        raise Unsupported("a construct of next year")

    file = write(tmp_path, {"a.xacro": robot(BODY)})
    _, ours = opened(file)
    monkeypatch.setattr(Evaluation, "run", unknown)
    _, stock = opened(file)
    assert (stock.evaluator, stock.fallback_reason) == ("xacro", "a construct of next year")
    assert stock.part_order == ours.part_order
    assert [p.xml for p in stock.changed_parts] == [p.xml for p in ours.changed_parts]


def test_parts_declare_the_prefixes_they_use(tmp_path: Path):
    body = '<gazebo><c:grip/></gazebo><link name="l"/>'
    file = write(tmp_path, {"a.xacro": robot(body, 'name="r" xmlns:c="http://c"')})
    _, answer = opened(file)
    assert [part.xml for part in answer.changed_parts] == [
        '<gazebo xmlns:c="http://c"><c:grip/></gazebo>',
        '<link name="l"/>',
    ]


def test_a_repeated_name_gets_a_key_of_its_own(tmp_path: Path):
    file = write(tmp_path, {"a.urdf": '<robot name="r"><link name="a"/><link name="a"/></robot>'})
    _, answer = opened(file)
    assert answer.part_order == ("link:a", "link:a#2")


PLACES = (
    '<xacro:macro name="ball" params="r:=1"><link name="${r}"><visual><origin xyz="1 2 3"/>'
    '</visual></link></xacro:macro>\n<xacro:ball/>\n<xacro:property name="p" value="7"/>\n'
    '<xacro:property name="other" value="important"/>\n<x a="${p} ${other}"/>'
    "<y a=\"${xacro.load_yaml('l.yaml')['s']}\"/>"
)


PROPERTY = '<xacro:property name="p" value="7"/>\n'


def typed(side: SideBySide, file: Path, old: str, new: str) -> None:
    """Type until a text reads another way: the bytes that are the same at both ends stay."""
    before = side.told.sources.text(str(file))
    assert before.count(old.encode()) == 1
    edit = difference(str(file), before, before.replace(old.encode(), new.encode()))
    assert edit is not None
    side.splice(edit)


@pytest.mark.parametrize(
    ("name", "texts"),
    [
        ("r.xacro", [PROPERTY, "<!-- cut -->", PROPERTY]),
        ("r.xacro", ['="1 2 3"/', '="1 2 3/', '="1 2 3"/']),
        ("r.xacro", ['="1 2 3"/', "=1 2 3/", '="1 2 3"/']),
        ("r.xacro", ["r:=1", "r:=1 b:=2"]),
        ("r.xacro", ["r:=1", "r:=", "r:=12 b:=3"]),
        ("l.yaml", ["s: abc", "s: abc # it is"]),
        ("l.yaml", ["s: abc", "s: abc #"]),
        ("l.yaml", ["s: abc", "a: b\ns: abc"]),
    ],
)
def test_after_typing_across_a_text_the_next_run_says_where_it_is(
    tmp_path: Path, name: str, texts: list[str]
):
    file = write(tmp_path, {"r.xacro": robot(PLACES), "l.yaml": "s: abc\nt: 1\n"})
    side = SideBySide(file, policy_for(tmp_path))
    for old, new in pairwise(texts):
        typed(side, tmp_path / name, old, new)
    assert side.told.failure is None
    assert side.misplaced() == []


def test_a_line_that_was_cut_and_brought_back_by_undo_is_written_where_it_stands(tmp_path: Path):
    file = write(tmp_path, {"r.xacro": robot(PLACES), "l.yaml": "s: abc\n"})
    side = SideBySide(file, policy_for(tmp_path))
    site = next(one for one in side.told.sites if side.told.site(one).name == "p")
    typed(side, file, PROPERTY, "")
    assert side.told.failure is not None
    with pytest.raises(StaleEditError):
        side.edit(site, "8")
    side.undo()
    side.edit(site, "8")
    expected = file.read_bytes().replace(b'value="7"', b'value="8"')
    assert side.told.sources.text(str(file)) == expected


def test_a_file_read_anew_has_its_places_told(tmp_path: Path):
    file = write(tmp_path, {"a.xacro": robot(BODY)})
    session, first = opened(file)
    told = session.answer(ReloadRequest((str(file),), {}))
    assert isinstance(told, Expansion)
    assert told.changed_sites == first.changed_sites


def test_a_robot_that_has_become_empty_when_it_is_opened_again_says_so(tmp_path: Path):
    _, answer = opened(write(tmp_path, {"a.xacro": robot("")}))
    assert (answer.part_order, answer.site_order) == ((), ())


def test_a_number_typed_over_by_a_word_is_found_when_the_file_is_opened_again(tmp_path: Path):
    file = write(tmp_path, {"a.xacro": robot(BODY + '<origin xyz="0 0 0"/>')})
    _, first = opened(file)
    (site,) = (one for one in first.changed_sites if one.text == "0 0 0")
    unsaved = file.read_bytes().replace(b"0 0 0", b"upwards")
    request = OpenRequest(
        str(file), {}, policy_for(tmp_path), {str(file): unsaved}, known=(site.id,)
    )
    _, answer = open_session(request)
    assert isinstance(answer, Expansion), answer
    (again,) = (one for one in answer.changed_sites if one.id == site.id)
    assert unsaved[again.span.start : again.span.end] == again.text.encode() == b"upwards"


@pytest.mark.parametrize("seed", some_of(range(4), 4))
def test_after_random_typing_every_text_is_where_one_who_opens_the_file_finds_it(seed: int):
    file = MODELS / "rover_description/urdf/rover.urdf.xacro"
    side, choose = SideBySide(file, policy_for(MODELS)), random.Random(seed)
    looked = 0
    while looked < 6:
        for _ in range(choose.randint(1, 5)):
            _one_of_many_changes(side, choose)
        while side.told.failure is not None:
            side.undo()
        assert side.misplaced() == []
        looked += 1


def _one_of_many_changes(side: SideBySide, choose: random.Random) -> None:
    """Drag a slider, type anywhere in the file, or take something back."""
    file, site = side.request.entry, choose.choice(side.told.sites)
    match choose.choice(["drag", "type", "type", "undo"]):
        case "drag":
            with suppress(StaleEditError):
                side.edit(site, f"{choose.uniform(0.1, 9):.{choose.randint(0, 4)}f}")
        case "undo" if side.told.sources.undo_labels:
            side.undo()
        case _:
            text = side.told.sources.text(file)
            start = choose.randrange(len(text))
            end = min(len(text), start + choose.choice([0, 0, 1, 1, 2, 30]))
            new = choose.choice([b"", b"1", b" ", b'"', b"\n", b" b:=2", text[start:end][::-1]])
            side.splice(Edit(file, start, end, new))
