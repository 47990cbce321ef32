"""One selection: made in 3D, the tree, the source or a table, it is seen in the three others."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import pytest

from tests.support.studio_page import StudioPage, wait_until

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from tests.support.shared_tab import SharedTab

pytestmark = [pytest.mark.browser, pytest.mark.network, pytest.mark.timeout(240)]

_BOX = '<visual><origin xyz="0 0 {z}"/><geometry><box size="0.2 0.2 {h}"/></geometry></visual>'
_FILLER = "\n".join(f"  <!-- {number} -->" for number in range(60))
ARM = f"""<robot name="arm">
  <link name="base">{_BOX.format(z=0.05, h=0.1)}</link>
  <link name="upper">{_BOX.format(z=0.3, h=0.5)}</link>
  <joint name="shoulder" type="revolute">
    <parent link="base"/><child link="upper"/><origin xyz="0 0 0.1"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/>
  </joint>
{_FILLER}
  <link name="tip">{_BOX.format(z=0.2, h=0.3)}</link>
  <joint name="elbow" type="revolute">
    <parent link="upper"/><child link="tip"/><origin xyz="0 0 0.6"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/>
  </joint>
</robot>
"""
_PLACE_OF = """(link) => {
  const { studio3d, innerWidth, innerHeight } = document.querySelector("iframe").contentWindow;
  for (let y = 20; y < innerHeight - 20; y += 5)
    for (let x = 20; x < innerWidth - 20; x += 5)
      if (studio3d.linkAt(x, y) === link) return [x, y];
  return null;
}"""
_AXES = """() => Object.entries(
  document.querySelector("iframe").contentWindow.__viserMutable.nodeRefFromName)
  .filter(([name, node]) => name.endsWith("/studio_axis") && node)
  .map(([name]) => name.split("/")[2])"""
_FRONT = """() => [...document.querySelectorAll('[role=tab][aria-selected=true]')]
  .map((tab) => tab.textContent.trim())"""
_LINE_IN_VIEW = """(line) => {
  const { top, bottom } = line.getBoundingClientRect();
  const around = line.closest(".cm-scroller").getBoundingClientRect();
  return top >= around.top - 1 && bottom <= around.bottom + 1;
}"""
NOTHING: Final[dict[str, list[str]]] = {"tree": [], "joints": [], "source": []}


@pytest.fixture(scope="module")
def arm(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("arm") / "arm.urdf"


@pytest.fixture(scope="module")
def opened(shared: SharedTab, arm: Path) -> StudioPage:
    arm.write_text(ARM)
    tab = shared.opened(shared.instead(arm))
    tab.page.get_by_role("tab", name="Joints").click()
    wait_until("the joints in front", lambda: "Joints" in tab.page.evaluate(_FRONT))
    tab.page.locator(".cm-line", has_text="<robot").wait_for()
    return tab


@pytest.fixture
def tab(opened: StudioPage, arm: Path) -> Iterator[StudioPage]:
    """A tab that shows the arm, of which nothing is selected."""
    yield opened
    arm.write_text(ARM)
    opened.page.get_by_role("treeitem", name="tip").wait_for()
    opened.page.keyboard.press("Escape")
    wait_until("nothing to be selected", lambda: seen(opened) == NOTHING)
    assert opened.errors == []


def seen(tab: StudioPage) -> dict[str, list[str]]:
    """What each of the places shows as selected."""
    page = tab.page
    line = page.locator(".source-chosen")
    return {
        "tree": page.locator("[role=treeitem][aria-selected=true] .tree-label").all_inner_texts(),
        "joints": page.locator(".joint.chosen .joint-name").all_inner_texts(),
        "source": [text.strip().split(">")[0] for text in line.all_inner_texts()],
    }


def selection(link: str, joint: str, line: str) -> dict[str, list[str]]:
    return {"tree": [link], "joints": [joint], "source": [line]}


def test_what_is_selected_in_one_of_four_is_seen_in_the_other_three(tab: StudioPage):
    page = tab.page
    front = page.evaluate(_FRONT)
    plain = tab.settle()

    page.get_by_role("treeitem", name="tip").click()
    tip = selection("tip", "elbow", '<link name="tip"')
    wait_until("the tip everywhere", lambda: seen(tab) == tip)
    line = page.locator(".source-chosen")
    wait_until("its line in view", lambda: line.evaluate(_LINE_IN_VIEW))
    tab.show_other_than(plain)
    assert page.evaluate("document.activeElement.id") == "row-link:tip"

    place = page.evaluate(_PLACE_OF, "upper")
    assert place is not None
    page.locator("iframe").click(position={"x": place[0], "y": place[1]})
    upper = selection("upper", "shoulder", '<link name="upper"')
    wait_until("the upper arm everywhere", lambda: seen(tab) == upper)
    wait_until("its line in view", lambda: line.evaluate(_LINE_IN_VIEW))
    wait_until("no axis in 3D", lambda: page.evaluate(_AXES) == [])

    page.keyboard.press("Escape")
    wait_until("nothing anywhere", lambda: seen(tab) == NOTHING)
    page.locator(".cm-line", has_text='type="revolute"').first.click()
    shoulder = selection("upper", "shoulder", '<joint name="shoulder" type="revolute"')
    wait_until("the shoulder everywhere", lambda: seen(tab) == shoulder)
    wait_until("its axis in 3D", lambda: page.evaluate(_AXES) == ["upper"])
    assert "cm-content" in page.evaluate("document.activeElement.className")

    page.get_by_role("button", name="elbow", exact=True).click()
    elbow = selection("tip", "elbow", '<joint name="elbow" type="revolute"')
    wait_until("the elbow everywhere", lambda: seen(tab) == elbow)
    wait_until("its line in view", lambda: line.evaluate(_LINE_IN_VIEW))
    wait_until("its axis in 3D", lambda: page.evaluate(_AXES) == ["tip"])
    assert "joint-name" in page.evaluate("document.activeElement.className")

    assert page.evaluate(_FRONT) == front


def test_a_part_that_is_gone_is_not_selected_any_more(tab: StudioPage, arm: Path):
    page = tab.page
    page.get_by_role("button", name="elbow", exact=True).click()
    wait_until("its axis in 3D", lambda: page.evaluate(_AXES) == ["tip"])
    arm.write_text(ARM.split('  <link name="tip">', maxsplit=1)[0] + "</robot>\n")
    wait_until("a smaller robot", lambda: page.get_by_role("treeitem", name="tip").count() == 0)
    wait_until("no axis", lambda: page.evaluate(_AXES) == [])
    assert seen(tab)["joints"] == []
