from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

from studio.errors import CommandError, StudioError, ViewError
from studio.live.displays import saved_views
from studio.live.displays.display_file import DisplayFile, KeptDisplays
from studio.live.displays.saved_views import SavedViews
from studio.protocol.listeners import Audience
from studio.protocol.views import DeleteView, GetViewKinds, MoveView, RenameView, SaveView
from studio.rviz.views import VIEW_KINDS, ViewSpec
from tests.support.open_documents import Ear

if TYPE_CHECKING:
    from pathlib import Path

SIDE = SaveView(kind="Orbit", name=" Side ", values={"Yaw": 1.5, "Pitch": 99.0})


class Shelf:
    """Saved views with a page that hears of them, and how often they were kept."""

    def __init__(self) -> None:
        self.ear, self.kept, audience = Ear(), 0, Audience()
        audience.add(self.ear)
        self.views = SavedViews(audience, self.count)

    def count(self) -> None:
        self.kept += 1

    @property
    def told(self) -> list[dict[str, Any]]:
        return self.ear.last("saved_views")["views"]

    @property
    def names(self) -> list[str]:
        return [one["name"] for one in self.told]


def three() -> Shelf:
    shelf = Shelf()
    for name in ("Side", "Top", "Front"):
        shelf.views.save(SIDE.model_copy(update={"name": name}))
    return shelf


def test_a_view_is_saved_within_rvizs_ranges_and_told_to_all():
    shelf = Shelf()
    shelf.views.save(SIDE)
    [side] = shelf.told
    assert (side["kind"], side["name"], side["values"]["Yaw"]) == ("Orbit", "Side", 1.5)
    assert side["values"]["Pitch"] < 1.6
    assert shelf.kept == 1


def test_views_are_renamed_arranged_deleted_and_put_back_where_they_were():
    shelf = three()
    side, top, front = (one["id"] for one in shelf.told)
    shelf.views.rename(RenameView(view=side, name="Left"))
    shelf.views.move(MoveView(view=front, before=top))
    assert shelf.names == ["Left", "Front", "Top"]
    shelf.views.move(MoveView(view=side))
    assert shelf.names == ["Front", "Top", "Left"]
    shelf.views.delete(DeleteView(view=top))
    assert shelf.names == ["Front", "Left"]
    shelf.views.save(SaveView(kind="FPS", name="Top", values={}, before=side))
    assert shelf.names == ["Front", "Top", "Left"]
    assert len({one["id"] for one in shelf.told} | {top}) == 4


@pytest.mark.parametrize(
    ("command", "error"),
    [
        (SIDE.model_copy(update={"kind": "Ego"}), ViewError),
        (SIDE.model_copy(update={"values": {"Height": 3}}), ViewError),
        (SIDE.model_copy(update={"values": {"Yaw": True}}), StudioError),
        (SIDE.model_copy(update={"name": "  "}), CommandError),
        (SIDE.model_copy(update={"before": "v99"}), CommandError),
        (RenameView(view="v99", name="a"), CommandError),
        (MoveView(view="v99"), CommandError),
        (MoveView(view="v1", before="v99"), CommandError),
        (DeleteView(view="v99"), CommandError),
    ],
)
def test_what_cannot_be_done_is_refused_and_leaves_all_as_it_was(
    command: Any,  # noqa: ANN401 - of several kinds
    error: type[StudioError],
):
    shelf = three()
    before = shelf.views.specs
    work = {
        SaveView: shelf.views.save,
        RenameView: shelf.views.rename,
        MoveView: shelf.views.move,
        DeleteView: shelf.views.delete,
    }[type(command)]
    with pytest.raises(error):
        work(command)
    assert shelf.views.specs == before
    assert shelf.kept == 3


def test_there_is_an_end_to_how_many_are_saved(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(saved_views, "VIEWS_MAX", 3)
    with pytest.raises(CommandError, match="delete one first"):
        three().views.save(SIDE)


def test_what_was_kept_is_taken_up_again_and_what_is_no_view_is_left_out(tmp_path: Path):
    side = ViewSpec("Orbit", "Side", {"Yaw": 1, "Target Frame": "base_link"})
    file = DisplayFile(tmp_path, tmp_path / "a.urdf")
    file.write(KeptDisplays(views=(side, ViewSpec("Ego", "Old"))))
    shelf = Shelf()
    shelf.views.restore(file.read().views)
    assert shelf.views.specs == (side,)


def test_the_page_is_told_all_kinds_with_their_properties():
    kinds = Shelf().views.kinds(GetViewKinds(request=7)).kinds
    assert [one.kind for one in kinds] == list(VIEW_KINDS)
    pitch = next(one for one in kinds[0].properties if one.name == "Pitch")
    assert (pitch.unit, round(pitch.high or 0, 3)) == ("rad", 1.57)


def test_opened_from_a_file_they_take_the_place_of_those_that_were_there():
    shelf = three()
    shelf.views.restore([ViewSpec("TopDownOrtho", "Map")])
    assert shelf.names == ["Map"]
    assert shelf.kept == 3  # who opens a file keeps all of it at once
