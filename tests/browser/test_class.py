"""A presenter and three students in browsers: directly, behind nginx with TLS, and by relays."""

from __future__ import annotations

import sys
from contextlib import ExitStack
from typing import TYPE_CHECKING, NamedTuple

import pytest

from tests.support.certificates import make_certificates
from tests.support.class_tabs import (
    bar,
    copy_bar,
    give_control,
    hold_slider,
    is_pressed,
    join,
    let_go,
    orbit,
    press,
    press_in_bar,
    same_camera,
    shows,
    tab,
    value_of,
)
from tests.support.nginx import free_port, running_nginx
from tests.support.panel_pictures import SHOW_PANEL
from tests.support.relayed_studio import (
    RelayedStudio,
    complaints,
    note_when_shown,
    relayed_studio,
    same_places,
    shown_after,
)
from tests.support.server import RunningStudio, running_studio
from tests.support.studio_page import StudioPage, wait_until

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

    from playwright.sync_api import Browser, Locator

pytestmark = [pytest.mark.browser, pytest.mark.network]
PATH = "/class/robots"


class Served(NamedTuple):
    """A studio, and the addresses of its page: its own, and the one behind nginx."""

    studio: RunningStudio
    addresses: dict[str, str]


@pytest.fixture(scope="module")
def served(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    folder, tls_port = tmp_path_factory.mktemp("class"), free_port()
    certificates = make_certificates(folder, "front")
    words = ["demo", "--share", "--host", "127.0.0.1", "--base-path", PATH]
    with (
        running_studio([*words, "--trusted-proxy", "127.0.0.1"], folder / "data") as studio,
        running_nginx(folder / "nginx", studio.port, tls_port, certificates, f"{PATH}/"),
    ):
        behind = f"https://localhost:{tls_port}{PATH}/"
        yield Served(studio, {"directly": f"{studio.origin}{PATH}/", "nginx": behind})


@pytest.fixture
def relayed(tmp_path: Path) -> Iterator[RelayedStudio]:
    with relayed_studio(tmp_path) as made:
        yield made


class People(NamedTuple):
    """Their tabs."""

    presenter: StudioPage
    ada: StudioPage
    bob: StudioPage
    eve: StudioPage


@pytest.mark.parametrize("way", ["directly", pytest.param("nginx", marks=pytest.mark.sweep)])
def test_students_join_ask_for_control_drag_what_all_see_and_hand_it_back(
    browser: Browser, served: Served, way: str
):
    address, code = served.addresses[way], served.studio.class_code
    with ExitStack() as held:
        people = People(*(held.enter_context(tab(browser)) for _ in range(4)))
        people.presenter.open(f"{address}?token={served.studio.token}", view=False)
        for student, name in zip(people[1:], ("Ada", "Bob", "Eve"), strict=True):
            join(student, address, f"{name} {way}", code)
        assert "token" not in people.presenter.page.url
        dragged = one_of_two_gets_control_and_drags(people, way)
        control_is_given_back_and_taken(people, way, dragged)
        for one in people:
            assert one.errors == []


@pytest.mark.parametrize("drawn_within_s", [30.0, pytest.param(2.0, marks=pytest.mark.sweep)])
def test_a_class_at_two_relays_goes_on_at_one_when_the_other_is_killed(
    browser: Browser, relayed: RelayedStudio, drawn_within_s: float
):
    code, (ada_at, eve_at) = relayed.studio.class_code, relayed.addresses
    with ExitStack() as held:
        people = People(*(held.enter_context(tab(browser)) for _ in range(4)))
        people.presenter.open(relayed.studio.url)
        join(people.ada, ada_at, "Ada R", code, view=True)
        join(people.bob, ada_at, "Bob R", code, view=True)
        join(people.eve, eve_at, "Eve R", code)
        dragged = one_of_two_gets_control_and_drags(people, "R")
        two_go_on_at_the_other_relay(relayed, people, drawn_within_s)
        control_is_given_back_and_taken(people, "R", dragged)
        for one in people:
            assert complaints(one) == []


def one_of_two_gets_control_and_drags(people: People, way: str) -> float:
    """It is Ada; what she dragged is the radius of the wheels, to the value that is returned."""
    presenter, ada, bob, eve = people
    assert "code" not in ada.page.url
    looks_only(ada)
    press(bob, "Ask for control")
    press(ada, "Ask for control")
    give_control(presenter, f"Ada {way}")
    bar(ada).get_by_text("You have control").wait_for()
    for other in (presenter, bob, eve):
        bar(other).get_by_text(f"Ada {way} has control").wait_for()
    dragged = float(ada.drag_slider("wheel_radius", 0.7))
    for other in (presenter, bob, eve):
        shows(other, "wheel_radius", dragged)
        assert other.slider("wheel_radius").is_disabled()
    return dragged


def two_go_on_at_the_other_relay(
    relayed: RelayedStudio, people: People, drawn_within_s: float
) -> None:
    """Theirs is killed while Ada holds a slider: they are who they were, and see what all see."""
    presenter, ada, bob, eve = people
    before = value_of(presenter, "base_length")
    hold_slider(ada, "base_length", 0.8)
    held = float(ada.slider("base_length").input_value())
    for other in (presenter, eve):
        shows(other, "base_length", held)
    for one in (ada, bob):
        note_when_shown(one)
    relayed.first.kill()
    for one in (ada, bob):
        one.page.wait_for_url(f"{relayed.addresses.second}d/*")
    ada.page.mouse.up()
    for one in (ada, bob):
        after = shown_after(one)
        sys.stdout.write(
            f"Listed after {after.listed_s:.2f} s, drawn after {after.drawn_s:.2f} s\n"
        )
        assert after.drawn_s < drawn_within_s
    bar(ada).get_by_text("You have control").wait_for()
    bar(bob).get_by_text("Ada R has control").wait_for()
    wait_until("her hand to be up", lambda: is_pressed(ada, "Raise hand"))
    wait_until("his asking to be known", lambda: is_pressed(bob, "Asked for control"))
    for one in (presenter, ada, bob):
        shows(one, "base_length", held)
    all_of(same_places, presenter, ada, bob)
    press(ada, "Undo")
    for one in people:
        shows(one, "base_length", before)
    orbit(presenter, 120)
    all_of(same_camera, presenter, ada, bob)


def all_of(same: Callable[[StudioPage, StudioPage], bool], *tabs: StudioPage) -> None:
    """Wait until others have the same as the first."""
    first, *others = tabs
    wait_until("the same for all", lambda: all(same(first, one) for one in others))


def control_is_given_back_and_taken(people: People, way: str, dragged: float) -> None:
    """What was dragged stays; and Bob, who asked as well, holds a slider as it is taken back."""
    presenter, ada, bob, _ = people
    press(ada, "Give back")
    bar(presenter).wait_for(state="detached")
    shows(presenter, "wheel_radius", dragged)
    a_drag_that_is_cut_off_is_one_step(presenter, bob, f"Bob {way}")
    presenter.undo_all()


def looks_only(student: StudioPage) -> None:
    """Everything is seen, nothing can be changed, and the way to it is said."""
    bar(student).get_by_text("You are looking · the presenter has control").wait_for()
    student.seek("wheel_radius")
    assert student.slider("wheel_radius").is_disabled()
    press(student, "Raise hand")
    wait_until("the hand to be up", lambda: is_pressed(student, "Raise hand"))


def a_drag_that_is_cut_off_is_one_step(
    presenter: StudioPage, student: StudioPage, name: str
) -> None:
    """Control is taken back while the student holds a slider: it keeps the value it had by then."""
    before = value_of(presenter, "base_length")
    presenter.page.get_by_role("button", name=f"Give control to {name}").click()
    bar(student).get_by_text("You have control").wait_for()
    hold_slider(student, "base_length", 0.8)
    wait_until("all to see it", lambda: value_of(presenter, "base_length") != before)
    press_in_bar(presenter, "Take back")
    bar(student).get_by_text("You are looking").wait_for()
    let_go(student, "base_length", 0.2)
    cut_off = value_of(presenter, "base_length")
    shows(student, "base_length", cut_off)
    presenter.page.get_by_role("button", name="Undo", exact=True).first.click()
    shows(presenter, "base_length", before)
    shows(student, "base_length", before)


def test_a_student_follows_camera_selection_and_panel_explores_and_is_brought_back(
    browser: Browser, served: Served
):
    address = served.addresses["directly"]
    with tab(browser) as presenter, tab(browser) as ada:
        presenter.open(f"{address}?token={served.studio.token}")
        join(ada, address, "Follower", served.studio.class_code, view=True)
        wait_until("the robot to be drawn", ada.has_drawn_robot)
        orbit(presenter, 120)
        wait_until("the same camera", lambda: same_camera(presenter, ada))
        presenter.page.get_by_role("treeitem", name="mast", exact=True).click()
        row = ada.page.get_by_role("treeitem", name="mast", exact=True)
        wait_until("the selection", lambda: row.get_attribute("aria-selected") == "true")
        presenter.page.get_by_role("tab", name="Joints").click()
        joints = ada.page.get_by_role("tab", name="Joints")
        wait_until("the panel", lambda: joints.get_attribute("aria-selected") == "true")
        bar(ada).get_by_text("Following the presenter").wait_for()
        orbit(ada, -80)
        bar(ada).get_by_text("You are exploring").wait_for()
        orbit(presenter, 60)
        assert not same_camera(presenter, ada)
        press_in_bar(ada, "Follow the presenter")
        wait_until("the same camera again", lambda: same_camera(presenter, ada))
        orbit(ada, -80)
        bar(ada).get_by_text("You are exploring").wait_for()
        presenter.page.keyboard.press("Control+K")
        presenter.page.keyboard.type("Bring everybody here")
        presenter.page.keyboard.press("Enter")
        wait_until("everybody here", lambda: same_camera(presenter, ada))
        assert presenter.errors == ada.errors == []


def test_a_copy_is_tried_on_handed_in_compared_shown_and_sent_back(
    browser: Browser, served: Served
):
    address = served.addresses["nginx"]
    with ExitStack() as held:
        presenter, ada, bob = (held.enter_context(tab(browser)) for _ in range(3))
        presenter.open(f"{address}?token={served.studio.token}", view=False)
        for student, name in ((ada, "Ada C"), (bob, "Bob C")):
            join(student, address, name, served.studio.class_code)
        shared = value_of(presenter, "mast_height")
        press(ada, "My copy")
        copy_bar(ada).get_by_text("Your copy: only you and the presenter change it").wait_for()
        changed = float(ada.drag_slider("mast_height", 0.9))
        assert value_of(presenter, "mast_height") == shared != changed
        press(ada, "Hand in")
        copy_bar(ada).get_by_text("1 change").wait_for()
        presenter.page.keyboard.press("Control+K")
        presenter.page.keyboard.type("People")
        presenter.page.keyboard.press("Enter")
        presenter.page.get_by_role(
            "button", name="Open the copy of Ada C: 1 change handed in"
        ).click()
        copy_bar(presenter).get_by_text("Copy of Ada C").wait_for()
        shows(presenter, "mast_height", changed)
        press(presenter, "Compare with the original")
        table = presenter.page.get_by_role("region", name="Variants")
        table.get_by_text("mast_height").first.wait_for()
        press(presenter, "Show to all")
        copy_bar(bob).get_by_text("A copy that the presenter shows to all").wait_for()
        shows(bob, "mast_height", changed)
        assert bob.slider("mast_height").is_disabled()
        press(presenter, "Send back…")
        presenter.page.get_by_label("Remark for the owner").fill("Too <b>high</b>, I think.")
        presenter.page.get_by_role("dialog").get_by_role("button", name="Send back").click()
        ada.page.get_by_text("Remark: Too <b>high</b>, I think.").wait_for()
        press(ada, "Back to the class")
        bar(ada).get_by_text("You are looking").wait_for()
        assert value_of(ada, "mast_height") == shared
        for one in (presenter, ada, bob):
            assert one.errors == []


def lessons_of(tab: StudioPage) -> Locator:
    """Bring the panel of lessons to the front."""
    tab.page.evaluate(SHOW_PANEL, "lessons")
    return tab.page.get_by_role("region", name="Lessons", exact=True)


def test_a_lesson_is_written_turns_green_for_one_and_the_teacher_sees_it(
    browser: Browser, served: Served
):
    address = served.addresses["nginx"]
    with ExitStack() as held:
        presenter, ada, bob = (held.enter_context(tab(browser)) for _ in range(3))
        presenter.open(f"{address}?token={served.studio.token}", view=False)
        lessons = lessons_of(presenter)
        lessons.get_by_role("button", name="Write a lesson").click()
        lessons.get_by_role("textbox", name="Name").fill("larger-wheel")
        text = lessons.get_by_role("textbox", name="Text")
        text.fill(f"{text.input_value()}check: node talker runs\n<script>alert(1)</script>\n")
        lessons.get_by_role("status").get_by_text("write it as `node /NAME runs`").wait_for()
        text.fill(text.input_value().replace("check: node talker runs\n", ""))
        wait_until("no fault", lambda: lessons.locator(".lesson-faults li").count() == 0)
        lessons.get_by_role("button", name="Save").click()
        lessons.get_by_text("0 of 2 steps done").wait_for()
        for student, name in ((ada, "Ada <i>L</i>"), (bob, "=Bob L")):
            join(student, address, name, served.studio.class_code)
            read = lessons_of(student)
            read.get_by_role("searchbox").fill("larger")
            read.get_by_role("button", name="larger-wheel").click()
            read.get_by_text("0 of 2 steps done").wait_for()
            read.get_by_text("<script>alert(1)</script>").wait_for()
            assert read.get_by_role("button", name="Edit this lesson").count() == 0
        ada.page.evaluate(SHOW_PANEL, "origin")
        lessons_of(ada).get_by_text("1 of 2 steps done").wait_for()
        lessons.get_by_role("button", name="Who has done it").click()
        row = lessons.get_by_role("row", name="Ada <i>L</i>")
        row.get_by_role("img", name="1. Try").wait_for()
        assert lessons.get_by_role("row", name="=Bob L").get_by_role("img", name="Try").count() == 0
        lessons_of(bob).get_by_text("0 of 2 steps done").wait_for()
        with presenter.page.expect_download() as saved:
            lessons.get_by_role("button", name="Save as CSV").click()
        table = saved.value.path().read_text(encoding="utf-8").splitlines()
        assert table[0] == "Name,1. Try,2. Try"
        assert any(line.startswith("Ada <i>L</i>,20") and line.endswith(",") for line in table)
        assert "'=Bob L,," in table
        for one in (presenter, ada, bob):
            assert one.errors == []
