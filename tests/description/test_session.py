"""A session answers what each request changed, and keeps the last good robot."""

from __future__ import annotations

from typing import TYPE_CHECKING

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
from tests.support.descriptions import policy_for, robot, write

if TYPE_CHECKING:
    from pathlib import Path

    import pytest

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
