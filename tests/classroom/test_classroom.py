from __future__ import annotations

import asyncio
import time
from typing import TYPE_CHECKING

import pytest

from studio.classroom import control as control_module
from studio.classroom import members as members_module
from studio.classroom.classroom import Classroom, Reach
from studio.classroom.members import MEMBERS_MAX
from studio.errors import CommandError, NotJoiningError
from studio.protocol.classroom import SetClass, SetMemberRole
from studio.protocol.roles import Role
from tests.support.open_documents import Ear

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable
    from pathlib import Path

    from studio.classroom.members import Member

REACH = Reach(("http://robots.example/",), only_here=False)


class Page(Ear):
    """A page of a member, whose role is theirs."""

    def __init__(self, member: Member) -> None:
        super().__init__(member.role)
        self.person = member.person


class Hands:
    """Notes what a classroom does with the robot."""

    def __init__(self) -> None:
        self.may_go_on: Callable[[str], bool] = bool
        self.stops = 0

    def release(self, may_go_on: Callable[[str], bool], /) -> None:
        self.may_go_on = may_go_on

    async def stop(self) -> None:
        self.stops += 1


def run(work: Callable[[Classroom], Awaitable[None]], file: Path | None = None) -> None:
    """Do something with an open class."""

    async def begin() -> None:
        made = Classroom(file, REACH)
        await made.start()
        try:
            await work(made)
        finally:
            await made.close()

    asyncio.run(begin())


async def joined(made: Classroom, name: str = "Ada") -> Member:
    return await made.join(name, made.admission.code, "", "")


async def until(condition: Callable[[], bool]) -> None:
    """Wait until something has happened that nobody is told of."""
    async with asyncio.timeout(60):
        while not condition():  # noqa: ASYNC110
            await asyncio.sleep(0.01)


async def told(ear: Ear, kind: str, **fields: object) -> None:
    """Wait until it has heard such an event."""
    await until(
        lambda: any(one["type"] == kind and fields.items() <= one.items() for one in ear.events)
    )


def test_a_new_page_learns_who_it_is_and_who_has_control():
    async def work(made: Classroom) -> None:
        ada = await joined(made)
        page, presenter = Page(ada), Ear()
        for one in (page, presenter):
            made.attach(one)
        assert page.last("you")["name"] == "Ada"
        assert page.last("you")["has_control"] is False
        assert presenter.last("you")["has_control"] is True
        assert page.last("control") == {
            "type": "control",
            "class_open": True,
            "holder": "",
            "name": "",
            "document": "",
        }

    run(work)


def test_only_those_who_lead_are_told_of_others_and_of_the_code():
    async def work(made: Classroom) -> None:
        pages = [Page(await joined(made, name)) for name in ("Ada", "Bob")]
        presenter = Ear()
        for one in (presenter, *pages):
            made.attach(one)
        await told(presenter, "class_state", code=made.admission.code)
        assert presenter.last("class_state")["link"].startswith("http://robots.example/join?code=")
        assert not [event for page in pages for event in page.events if "members" in event]
        assert not any(made.admission.code in str(page.events) for page in pages)

    run(work)


def test_control_is_asked_for_given_seen_by_all_and_taken_back():
    async def work(made: Classroom) -> None:
        made.robot = hands = Hands()
        ada, bob = await joined(made), await joined(made, "Bob")
        pages = {one.name: Page(one) for one in (ada, bob)}
        presenter = Ear()
        for page in (presenter, *pages.values()):
            made.attach(page)
        made.ask_control(bob.person, asking=True)
        made.ask_control(ada.person, asking=True)
        await told(presenter, "class_state")
        made.give_control(ada.person)
        assert ada.controls("")
        assert not bob.controls("")
        assert pages["Ada"].last("you")["has_control"] is True
        assert hands.may_go_on(ada.person)
        assert not hands.may_go_on(presenter.person)
        assert pages["Bob"].last("control")["name"] == "Ada"
        assert pages["Bob"].last("you")["asking"] is True
        assert presenter.last("you")["has_control"] is False
        made.take_control(presenter)
        assert not ada.controls("")
        assert presenter.last("you")["has_control"] is True
        assert not hands.may_go_on(ada.person)
        assert hands.may_go_on(presenter.person)

    run(work)


def test_it_is_not_given_to_who_is_gone_or_only_looks():
    async def work(made: Classroom) -> None:
        ada = await joined(made)
        with pytest.raises(CommandError, match="Ada is not here"):
            made.give_control(ada.person)
        made.attach(Page(ada))
        await made.set_role(SetMemberRole(person=ada.person, role="guest"))
        with pytest.raises(CommandError, match="Ada only looks"):
            made.give_control(ada.person)
        with pytest.raises(CommandError, match="not in the class"):
            made.give_control("nobody")

    run(work)


def test_two_who_ask_at_once_wait_in_the_order_in_which_they_asked():
    async def work(made: Classroom) -> None:
        people = [await joined(made, name) for name in ("Ada", "Bob", "Eve")]
        presenter = Ear()
        for page in (presenter, *map(Page, people)):
            made.attach(page)
        for one in reversed(people):
            made.ask_control(one.person, asking=True)
        made.give_control(people[2].person)
        await told(presenter, "control", name="Eve")
        waiting = [one.name for one in made.members if one.asks_s is not None]
        assert sorted(waiting) == ["Ada", "Bob"]
        asked = {one.name: one.asks_s or 0.0 for one in people}
        assert asked["Bob"] <= asked["Ada"]

    run(work)


def test_it_returns_when_the_last_page_of_its_holder_is_gone_and_does_not_come_back(
    monkeypatch: pytest.MonkeyPatch,
):
    monkeypatch.setattr(control_module, "ABSENCE_S", 0.05)

    async def work(made: Classroom) -> None:
        ada = await joined(made)
        first, second, presenter = Page(ada), Page(ada), Ear()
        for page in (first, second, presenter):
            made.attach(page)
        made.give_control(ada.person)
        made.detach(first)
        await asyncio.sleep(0.1)
        assert ada.controls("")
        made.detach(second)
        made.attach(second)
        await asyncio.sleep(0.1)
        assert ada.controls("")
        made.detach(second)
        await until(lambda: not made.control.holder)
        assert presenter.last("control")["holder"] == ""

    run(work)


def test_a_presenter_who_is_gone_keeps_it_and_a_helper_may_take_it():
    async def work(made: Classroom) -> None:
        ada = await joined(made)
        await made.set_role(SetMemberRole(person=ada.person, role="helper"))
        presenter = Ear()
        made.attach(presenter)
        made.detach(presenter)
        helper = Page(ada)
        made.attach(helper)
        assert helper.last("class_state")["members"][0]["name"] == "Ada"
        made.take_control(helper)
        assert made.control.holder == ada.person

    run(work)


def test_who_is_sent_out_loses_everything_and_stays_out_until_let_in():
    async def work(made: Classroom) -> None:
        ended: list[str] = []
        made.end_pages = ended.append
        ada = await joined(made)
        cookie = made.members.cookie_of(ada)
        made.attach(Page(ada))
        made.give_control(ada.person)
        await made.remove(ada.person)
        assert (ended, made.control.holder) == ([ada.person], "")
        assert made.member_of_cookie(cookie) is None
        with pytest.raises(NotJoiningError) as refused:
            await made.join("Eve", made.admission.code, "", cookie)
        assert refused.value.why == "removed"
        await made.readmit(ada.person)
        assert made.member_of_cookie(cookie) is ada

    run(work)


def test_a_browser_that_joins_again_is_the_same_person():
    async def work(made: Classroom) -> None:
        ada = await joined(made)
        again = await made.join("Other", made.admission.code, "", made.members.cookie_of(ada))
        assert again is ada
        assert len(made.members) == 1

    run(work)


def test_all_come_back_after_the_studio_was_killed(tmp_path: Path):
    file = tmp_path / "class.json"
    kept: dict[str, str] = {}

    async def before(made: Classroom) -> None:
        ada, bob = await joined(made), await joined(made, "Bob")
        await made.set_role(SetMemberRole(person=ada.person, role="helper"))
        await made.remove(bob.person)
        await made.set(SetClass(locked=True, password="sesame"))
        kept.update(
            ada=made.members.cookie_of(ada),
            bob=made.members.cookie_of(bob),
            code=made.admission.code,
        )

    async def after(made: Classroom) -> None:
        ada = made.member_of_cookie(kept["ada"])
        assert ada is not None
        assert (ada.name, ada.role) == ("Ada", Role.HELPER)
        assert made.member_of_cookie(kept["bob"]) is None
        assert made.admission.code == kept["code"]
        assert made.admission.locked
        await made.admission.check_password("sesame")

    run(before, file)
    run(after, file)


def test_the_end_of_a_class_deletes_all_that_was_kept(tmp_path: Path):
    async def work(made: Classroom) -> None:
        ended: list[str] = []
        made.end_pages = ended.append
        ada = await joined(made)
        code, link = made.admission.code, made.admission.link
        cookie = made.members.cookie_of(ada)
        await made.end()
        assert ended == [ada.person]
        assert list(tmp_path.iterdir()) == []
        assert made.members.any_of_cookie(cookie) is None
        assert not made.admission.open
        assert code != made.admission.code
        assert link != made.admission.link

    run(work, tmp_path / "class.json")


def test_a_pause_sends_all_away_who_come_back_by_themselves():
    async def work(made: Classroom) -> None:
        ended: list[str] = []
        made.end_pages = ended.append
        ada = await joined(made)
        cookie = made.members.cookie_of(ada)
        await made.pause()
        assert ended == [ada.person]
        assert made.member_of_cookie(cookie) is None
        await made.start()
        assert made.member_of_cookie(cookie) is ada

    run(work)


def test_a_full_class_lets_the_one_go_who_is_not_here():
    async def work(made: Classroom) -> None:
        first = await joined(made, "first")
        for number in range(MEMBERS_MAX - 1):
            made.attach(Page(await joined(made, f"n{number}")))
        await joined(made, "one more")
        assert made.members.find(first.person) is None
        newest = next(one for one in made.members if one.name == "one more")
        made.attach(Page(newest))
        with pytest.raises(NotJoiningError) as refused:
            await joined(made, "too many")
        assert refused.value.why == "full"

    run(work)


def test_a_studio_that_may_not_be_shared_says_why():
    async def work() -> None:
        made = Classroom(None, Reach(why_not="Start it without --trust."))
        with pytest.raises(CommandError, match="without --trust"):
            await made.start()

    asyncio.run(work())


def test_three_hundred_who_come_and_leave_at_once_cost_their_leaders_few_lists():
    async def work(made: Classroom) -> None:
        presenter = Ear()
        made.attach(presenter)
        pages = [Page(await joined(made, f"n{number}")) for number in range(300)]
        for page in pages:
            made.attach(page)
        for page in pages:
            made.detach(page)

        def is_told() -> bool:
            members = presenter.last("class_state")["members"]
            return len(members) == 300 and not any(one["here"] for one in members)

        await until(is_told)
        assert sum(one["type"] == "class_state" for one in presenter.events) < 60

    run(work)


def test_a_stop_is_told_to_everybody_with_who_pressed_it():
    async def work(made: Classroom) -> None:
        made.robot = hands = Hands()
        page, presenter = Page(await joined(made)), Ear()
        for one in (page, presenter):
            made.attach(one)
        await made.stop_robot(page)
        await made.stop_robot(presenter)
        names = [one["name"] for one in presenter.events if one["type"] == "stopped"]
        assert (hands.stops, names) == (2, ["Ada", ""])

    run(work)


def test_a_name_is_changed_for_all_to_see():
    async def work(made: Classroom) -> None:
        ada = await joined(made)
        page, presenter = Page(ada), Ear()
        for one in (page, presenter):
            made.attach(one)
        made.give_control(ada.person)
        await made.rename(ada.person, "  Grace <i> ")
        assert page.last("you")["name"] == "Grace <i>"
        assert presenter.last("control")["name"] == "Grace <i>"
        with pytest.raises(CommandError):
            await made.rename("nobody", "Eve")

    run(work)


class Clock:
    """The system's clock, which somebody set forth or back by some days."""

    def __init__(self) -> None:
        self.days = 0

    def time_ns(self) -> int:
        return time.time_ns() + self.days * 86_400 * 10**9


def test_those_who_wait_keep_their_order_though_the_clock_is_set_back(
    monkeypatch: pytest.MonkeyPatch,
):
    clock = Clock()
    monkeypatch.setattr(members_module, "time", clock)

    async def work(made: Classroom) -> None:
        people = [await joined(made, f"n{number}") for number in range(5)]
        for clock.days, one in zip((0, -1, 1, -400, 0), people, strict=True):
            made.attach(Page(one))
            made.ask_control(one.person, asking=True)
            made.raise_hand(one.person, raised=True)
        for waiting in ([one.asks_s or 0 for one in people], [one.hand_s or 0 for one in people]):
            assert waiting == sorted(set(waiting))

    run(work)


@pytest.mark.parametrize("days", [-1, 1])
def test_a_clock_that_jumps_neither_takes_control_nor_keeps_it_from_returning(
    monkeypatch: pytest.MonkeyPatch, days: int
):
    monkeypatch.setattr(control_module, "ABSENCE_S", 0.05)
    now_s, now_ns = time.time, time.time_ns  # noqa: TID251 - they are what jumps

    async def work(made: Classroom) -> None:
        ada = await joined(made)
        page, presenter = Page(ada), Ear()
        for one in (page, presenter):
            made.attach(one)
        made.give_control(ada.person)
        monkeypatch.setattr(time, "time", lambda: now_s() + days * 86_400)
        monkeypatch.setattr(time, "time_ns", lambda: now_ns() + days * 86_400 * 10**9)
        await asyncio.sleep(0.1)
        assert made.control.holder == ada.person
        assert made.member_of_cookie(made.members.cookie_of(ada)) is ada
        made.detach(page)
        await until(lambda: not made.control.holder)

    run(work)
