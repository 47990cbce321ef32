"""The report as one HTML file: whole, harmless and without names of persons."""

from __future__ import annotations

import json
import re
from html.parser import HTMLParser
from pathlib import Path
from typing import get_args

import pytest
from typing_extensions import override

from studio.live.doctor import subjects
from studio.live.doctor.examination import examine
from studio.live.doctor.report import About, report_html, without_homes, words_of
from studio.live.doctor.seen import Seen, SeenBrowser, SeenDisplay, SeenDocument
from studio.problems import Place, Problem, Severity
from studio.protocol.displays import DisplayState, Remark
from studio.protocol.doctor import Concern, Finding, Level, SubjectName, Talk
from studio.settings import repository_or_wheel

ASSETS = repository_or_wheel("frontend_assets")
HOSTILE = "</code><script>alert(1)</script><img src=x onerror=alert(2)>\"'&\u202e"
HOMES = "/" + "home"
CODE = re.compile(r'code="([\w-]+)"|\("([a-z]+(?:-[a-z]+)+)", "(?:error|warn|note)"\)')


class Read(HTMLParser):
    """What a browser would make of it: elements with their attributes, and all text."""

    def __init__(self, html: str) -> None:
        super().__init__(convert_charrefs=True)
        self.elements: list[tuple[str, dict[str, str | None]]] = []
        self.text = ""
        self.feed(html)

    @override
    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.elements.append((tag, dict(attrs)))

    @override
    def handle_data(self, data: str) -> None:
        self.text += data


def hostile() -> Seen:
    """A document whose every text wants to be carried out."""
    remark = Remark(level="error", reason=HOSTILE, sentence=HOSTILE)
    state = DisplayState(id="1", rate_hz=0, age_s=None, received=0, lost=0, remarks=(remark,))
    problem = Problem(Severity.ERROR, HOSTILE, HOSTILE, Place(HOSTILE, 3))
    return Seen(
        document=SeenDocument(
            HOSTILE, HOSTILE, displays=(SeenDisplay("1", HOSTILE, state),), problems=(problem,)
        ),
        browser=SeenBrowser(HOSTILE, draws_by_software=True),
    )


def html_of(seen: Seen, language: str = "en") -> str:
    about = About("de" if language == "de" else "en", (("router", HOSTILE),), "2026-01-02 03:04")
    return report_html(examine(seen), about, words_of(ASSETS, about.language))


@pytest.mark.parametrize("language", ["en", "de"])
def test_no_text_of_others_is_carried_out(language: str):
    read = Read(html_of(hostile(), language))
    tags = {tag for tag, _ in read.elements}
    assert not tags & {"script", "img", "iframe", "link", "object", "svg", "form", "a"}
    assert not [
        name for _, attributes in read.elements for name in attributes if name.startswith("on")
    ]
    assert read.text.count("<script>alert(1)</script>") >= 5
    (meta,) = (
        attributes
        for tag, attributes in read.elements
        if tag == "meta" and attributes.get("http-equiv") == "Content-Security-Policy"
    )
    assert meta["content"] == "default-src 'none'; style-src 'unsafe-inline'"


def test_it_loads_nothing_and_has_both_themes():
    html = html_of(hostile())
    assert "prefers-color-scheme: dark" in html
    assert not re.search(r"\b(?:src|href)=|url\(|@import", html.replace("src=x", ""))


def test_what_is_well_is_said_with_what_was_examined():
    html = html_of(Seen())
    assert "✔ All is well" in html
    read = Read(html_of(Seen(), "de"))
    assert "Alles in Ordnung" in read.text
    assert "Roboterbeschreibung" in read.text


def test_who_talks_to_whom_is_drawn():
    finding = Finding(
        code="type",
        level="error",
        subject="types",
        sentence="/x has 2 types.",
        evidence=("/a: std_msgs/msg/String",),
        about=(Concern(kind="topic", name="/x"),),
        talk=Talk(sources=("/a",), name="/x", targets=(), meets=False),
        line="ros2 topic info -v /x",
    )
    about = About("en", (), "now")
    found = examine(Seen())._replace(findings=(finding,), more=4)
    read = Read(report_html(found, about, words_of(ASSETS, "en")))
    assert "/a⇸/x⇸nobody" in read.text
    assert "$ ros2 topic info -v /x" in read.text
    assert "4 more findings" in read.text


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        (f"{HOMES}/anna/ws/arm.xacro:3 is wrong", "~/ws/arm.xacro:3 is wrong"),
        ('"/Users/bob"', '"~"'),
        (r"C:\Users\carla\ws", r"~\ws"),
        ("/opt/ros/jazzy/share", "/opt/ros/jazzy/share"),
        (f"{Path.home()}/x", "~/x"),
    ],
)
def test_home_folders_name_nobody(text: str, shown: str):
    assert without_homes(text) == shown


def test_no_home_folder_is_in_a_report():
    problem = Problem(Severity.ERROR, "x", f"{HOMES}/anna/arm.xacro is wrong.")
    html = html_of(Seen(document=SeenDocument("d", f"{HOMES}/anna/arm.xacro", problems=(problem,))))
    assert "anna" not in html
    assert "~/arm.xacro is wrong." in html


def test_each_finding_has_a_test_that_makes_it():
    words = json.loads((ASSETS / "panels/doctor/panel.json").read_text())["words"]["en"]
    codes = {one.removeprefix("doctor.code.") for one in words if one.startswith("doctor.code.")}
    folder = Path(__file__).with_name("subjects")
    tests = "".join(one.read_text(encoding="utf-8") for one in folder.glob("test_*.py"))
    assert {one for one in codes if f'"{one}"' not in tests} == set()


@pytest.mark.parametrize("language", ["en", "de"])
def test_every_finding_subject_and_level_has_its_words(language: str):
    words = json.loads((ASSETS / "panels/doctor/panel.json").read_text())["words"][language]
    folder = Path(subjects.__file__).parent
    codes = {
        found
        for path in folder.glob("*.py")
        for pair in CODE.findall(path.read_text(encoding="utf-8"))
        for found in pair
        if found
    }
    assert len(codes) > 40
    assert {code for code in codes if f"doctor.code.{code}" not in words} == set()
    assert all(f"doctor.subject.{one}" in words for one in get_args(SubjectName))
    assert all(f"doctor.level.{one}" in words for one in get_args(Level))
