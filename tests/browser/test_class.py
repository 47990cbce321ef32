"""A presenter and three students in browsers of their own, directly and behind nginx with TLS."""

from __future__ import annotations

from contextlib import ExitStack, contextmanager
from typing import TYPE_CHECKING, NamedTuple

import pytest

from tests.support.certificates import make_certificates
from tests.support.nginx import free_port, running_nginx
from tests.support.panel_pictures import SHOW_PANEL
from tests.support.server import RunningStudio, running_studio
from tests.support.studio_page import StudioPage, studio_context, wait_until

if TYPE_CHECKING:
    from collections.abc import Generator, Iterator

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


@contextmanager
def tab(browser: Browser) -> Generator[StudioPage]:
    """A browser of somebody's own; the certificate is that of the test."""
    context = studio_context(browser, ignore_https_errors=True)
    try:
        yield StudioPage(context.new_page())
    finally:
        context.close()


def join(tab: StudioPage, address: str, name: str, code: str, *, view: bool = False) -> StudioPage:
    """Come to the bare address, type the code and a name."""
    url = address[: address.index("/", 8)]
    if not view:
        tab.page.context.add_cookies([{"name": "without_view", "value": "1", "url": url}])
    tab.page.goto(address)
    tab.page.get_by_label("Code").fill(code)
    tab.page.get_by_label("Your name").fill(name)
    tab.page.get_by_role("button", name="Join").click()
    bar(tab).get_by_text("You are looking").wait_for()
    return tab


def bar(tab: StudioPage) -> Locator:
    """The bar that says who has control."""
    return tab.page.locator(".control-bar")


def press(tab: StudioPage, name: str) -> None:
    tab.page.get_by_role("button", name=name, exact=True).click()


def value_of(tab: StudioPage, name: str) -> float:
    tab.seek(name)
    return float(tab.box(name).input_value())


def shows(tab: StudioPage, name: str, value: float) -> None:
    wait_until(f"{name} to be {value:g}", lambda: abs(value_of(tab, name) - value) < 1e-9)


@pytest.mark.parametrize("way", ["directly", pytest.param("nginx", marks=pytest.mark.sweep)])
def test_students_join_ask_for_control_drag_what_all_see_and_hand_it_back(
    browser: Browser, served: Served, way: str
):
    address, code = served.addresses[way], served.studio.class_code
    with ExitStack() as held:
        presenter, ada, bob, eve = (held.enter_context(tab(browser)) for _ in range(4))
        presenter.open(f"{address}?token={served.studio.token}", view=False)
        for student, name in ((ada, "Ada"), (bob, "Bob"), (eve, "Eve")):
            join(student, address, f"{name} {way}", code)
        assert "token" not in presenter.page.url
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
        press(ada, "Give back")
        bar(presenter).wait_for(state="detached")
        shows(presenter, "wheel_radius", dragged)
        a_drag_that_is_cut_off_is_one_step(presenter, bob, f"Bob {way}")
        presenter.undo_all()
        for one in (presenter, ada, bob, eve):
            assert one.errors == []


def looks_only(student: StudioPage) -> None:
    """Everything is seen, nothing can be changed, and the way to it is said."""
    bar(student).get_by_text("You are looking · the presenter has control").wait_for()
    student.seek("wheel_radius")
    assert student.slider("wheel_radius").is_disabled()
    press(student, "Raise hand")
    pressed = student.page.get_by_role("button", name="Raise hand", exact=True)
    wait_until("the hand to be up", lambda: pressed.get_attribute("aria-pressed") == "true")


def give_control(presenter: StudioPage, name: str) -> None:
    """By the list of people, to which the window of sharing leads."""
    presenter.page.get_by_role("button", name="Share").click()
    presenter.page.locator(".class-code").wait_for()
    presenter.page.locator(".class-dialog footer .primary").click()
    presenter.page.get_by_role("button", name=f"Give control to {name}").click()


def a_drag_that_is_cut_off_is_one_step(
    presenter: StudioPage, student: StudioPage, name: str
) -> None:
    """Control is taken back while the student holds a slider: it keeps the value it had by then."""
    before = value_of(presenter, "base_length")
    presenter.page.get_by_role("button", name=f"Give control to {name}").click()
    bar(student).get_by_text("You have control").wait_for()
    student.seek("base_length")
    slider = student.slider("base_length")
    slider.scroll_into_view_if_needed()
    box = slider.bounding_box()
    assert box is not None
    begin = float(slider.evaluate("one => (one.value - one.min) / (one.max - one.min)"))
    y = box["y"] + box["height"] / 2
    student.page.mouse.move(box["x"] + box["width"] * begin, y)
    student.page.mouse.down()
    student.page.mouse.move(box["x"] + box["width"] * 0.8, y, steps=4)
    wait_until("all to see it", lambda: value_of(presenter, "base_length") != before)
    press_in_bar(presenter, "Take back")
    bar(student).get_by_text("You are looking").wait_for()
    student.page.mouse.move(box["x"] + box["width"] * 0.2, y, steps=4)
    student.page.mouse.up()
    cut_off = value_of(presenter, "base_length")
    shows(student, "base_length", cut_off)
    presenter.page.get_by_role("button", name="Undo", exact=True).first.click()
    shows(presenter, "base_length", before)
    shows(student, "base_length", before)


def press_in_bar(tab: StudioPage, name: str) -> None:
    bar(tab).get_by_role("button", name=name).click()


_CAMERA = "frame => frame.contentWindow.studio3d?.getCamera()"


def camera(tab: StudioPage) -> list[float]:
    """Its eye and what it looks at, in the root frame."""
    pose = tab.page.locator("iframe").evaluate(_CAMERA)
    return [*pose["position"], *pose["target"]]


def same_camera(one: StudioPage, other: StudioPage) -> bool:
    return all(abs(a - b) < 1e-4 for a, b in zip(camera(one), camera(other), strict=True))


def orbit(tab: StudioPage, x_px: float) -> None:
    """Drag the ground of the 3D view."""
    box = tab.page.locator("iframe").bounding_box()
    assert box is not None
    x, y = box["x"] + box["width"] * 0.7, box["y"] + box["height"] * 0.3
    tab.page.mouse.move(x, y)
    tab.page.mouse.down()
    tab.page.mouse.move(x + x_px, y + 30, steps=5)
    tab.page.mouse.up()


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


def copy_bar(tab: StudioPage) -> Locator:
    """The bar above a copy."""
    return tab.page.locator(".copy-bar")
