from dataclasses import replace

import pytest

from studio.errors import CommandError
from studio.live.displays.display_list import DISPLAYS_MAX, DisplayList


def names(displays: DisplayList) -> list[str]:
    return [one.name for one in displays]


def three() -> DisplayList:
    displays = DisplayList()
    for kind in ("LaserScan", "Path", "Map"):
        displays.add(kind)
    return displays


def test_each_is_named_after_its_kind_and_the_next_of_its_kind_is_numbered():
    displays = three()
    displays.add("Path")
    displays.add("Path")
    assert names(displays) == ["LaserScan", "Path", "Map", "Path 2", "Path 3"]


def test_a_copy_stands_behind_what_it_was_made_of_and_has_its_settings():
    displays = three()
    path = next(one for one in displays if one.kind == "Path")
    displays.change(replace(path, topic="/plan", values={"Alpha": 0.5}, name="Plan"))
    copy = displays.duplicate(path.id)
    assert names(displays) == ["LaserScan", "Plan", "Plan 2", "Map"]
    assert (copy.topic, copy.values) == ("/plan", {"Alpha": 0.5})
    assert copy.id != path.id


def test_one_is_moved_before_another_and_to_the_end():
    displays = three()
    scan, _, grid = (one.id for one in displays)
    displays.move(grid, scan)
    assert names(displays) == ["Map", "LaserScan", "Path"]
    displays.move(grid, "")
    assert names(displays) == ["LaserScan", "Path", "Map"]
    displays.move(scan, scan)
    assert names(displays) == ["LaserScan", "Path", "Map"]


def test_what_was_removed_is_not_there_any_more_and_its_id_is_not_given_again():
    displays = three()
    scan = next(iter(displays)).id
    displays.remove(scan)
    assert displays.add("Range").id != scan
    with pytest.raises(CommandError, match="not there any more"):
        displays.remove(scan)
    with pytest.raises(CommandError, match="not there any more"):
        displays.move("d2", "d99")
    assert names(displays) == ["Path", "Map", "Range"]


def test_a_group_is_hidden_as_a_whole_and_its_displays_stay_as_they_were():
    displays = three()
    path = next(one for one in displays if one.kind == "Path")
    displays.change(replace(path, group="Planning"))
    displays.switch_group("Planning", shown=False)
    assert [displays.is_shown(one) for one in displays] == [True, False, True]
    assert displays.groups_off == ("Planning",)
    displays.switch_group("Planning", shown=True)
    assert all(displays.is_shown(one) for one in displays)
    with pytest.raises(CommandError, match="no group"):
        displays.switch_group("Driving", shown=False)


def test_a_group_that_nothing_is_in_any_more_is_not_told_as_hidden():
    displays = three()
    path = next(one for one in displays if one.kind == "Path")
    displays.change(replace(path, group="Planning"))
    displays.switch_group("Planning", shown=False)
    displays.remove(path.id)
    assert displays.groups_off == ()


def test_there_is_an_end_to_adding():
    displays = DisplayList()
    for _ in range(DISPLAYS_MAX):
        displays.add("Path")
    assert len(displays) == DISPLAYS_MAX
    with pytest.raises(CommandError, match="remove one first"):
        displays.duplicate("d1")


def nested() -> DisplayList:
    """`LaserScan` in none, `Path` in `Nav/Local`, `Map` in `Nav`."""
    displays = three()
    for kind, group in (("Path", "Nav/Local"), ("Map", "Nav")):
        one = next(each for each in displays if each.kind == kind)
        displays.change(replace(one, group=group))
    return displays


def groups(displays: DisplayList) -> list[str]:
    return [one.group for one in displays]


def test_a_hidden_group_hides_the_groups_that_stand_in_it():
    displays = nested()
    displays.switch_group("Nav", shown=False)
    assert [displays.is_shown(one) for one in displays] == [True, False, False]
    assert [displays.hidden_by(one) for one in displays] == ["", "Nav", "Nav"]
    displays.switch_group("Nav", shown=True)
    displays.switch_group("Nav/Local", shown=False)
    assert [displays.is_shown(one) for one in displays] == [True, False, True]


def test_a_group_goes_into_another_with_all_that_is_in_it_and_stays_hidden():
    displays = nested()
    scan = next(iter(displays))
    displays.change(replace(scan, group="Sensors"))
    displays.switch_group("Nav/Local", shown=False)
    displays.regroup("Nav", "Sensors/Nav")
    assert groups(displays) == ["Sensors", "Sensors/Nav/Local", "Sensors/Nav"]
    assert displays.groups_off == ("Sensors/Nav/Local",)
    with pytest.raises(CommandError, match="cannot stand in itself"):
        displays.regroup("Sensors", "Sensors/Nav/Sensors")
    with pytest.raises(CommandError, match="7 others at most"):
        displays.regroup("Sensors", "a/b/c/d/e/f/g")
    assert displays.groups_off == ("Sensors/Nav/Local",)


def test_a_group_that_is_dissolved_leaves_what_was_in_it_where_it_stood():
    displays = nested()
    displays.switch_group("Nav/Local", shown=False)
    displays.regroup("Nav/Local", "")
    assert groups(displays) == ["", "Nav", "Nav"]
    assert all(displays.is_shown(one) for one in displays)
    displays.regroup("Nav", "")
    assert groups(displays) == ["", "", ""]


def test_a_group_is_moved_as_a_whole():
    displays = nested()
    displays.arrange_group("Nav", None, next(iter(displays)).id)
    assert names(displays) == ["Path", "Map", "LaserScan"]
    displays.arrange_group("Nav", "Way", "")
    assert names(displays) == ["LaserScan", "Path", "Map"]
    assert groups(displays) == ["", "Way/Local", "Way"]
    for to, before, why in (
        ("Other", "d99", "not there any more"),
        ("Other", "d2", "in it"),
        ("Way/Local", "d1", "itself"),
    ):
        with pytest.raises(CommandError, match=why):
            displays.arrange_group("Way", to, before)
    assert names(displays) == ["LaserScan", "Path", "Map"]
    assert groups(displays) == ["", "Way/Local", "Way"]


def test_what_was_removed_comes_back_where_it_stood_as_long_as_it_is_known():
    displays = three()
    scan, path, grid = (one.id for one in displays)
    displays.remove(path)
    displays.remove(grid)
    displays.put_back(path)
    displays.put_back(grid)
    assert names(displays) == ["LaserScan", "Path", "Map"]
    displays.remove(scan)
    displays.remove(path)
    displays.put_back(scan)
    assert names(displays) == ["LaserScan", "Map"]
    for _ in range(DISPLAYS_MAX):
        displays.remove(displays.add("Range").id)
    with pytest.raises(CommandError, match="too long ago"):
        displays.put_back(path)


def test_all_are_hidden_and_shown_each():
    displays = nested()
    displays.switch_group("Nav", shown=False)
    displays.switch_all(shown=False)
    assert not any(one.enabled for one in displays)
    displays.switch_all(shown=True)
    assert all(displays.is_shown(one) for one in displays)
