import pytest

from studio.displays.drawing import Solids
from studio.displays.markers.display import MarkerDisplay
from studio.displays.markers.kinds import Action, Kind
from tests.support.markers import TYPES, array_of, marker, shapes_in, single_of


@pytest.mark.parametrize("little", [True, False], ids=["little", "big"])
def test_single_markers_and_arrays_beside_them_are_of_one_store(little: bool):
    display = MarkerDisplay(TYPES)
    display.take(single_of(marker(Kind.CUBE, 1), little=little))
    display.take(array_of(marker(Kind.CUBE, 2), marker(Kind.SPHERE, 3), little=little), "array")
    found = shapes_in(display.draw(0))
    assert list(found) == ["boxes", "balls"]
    boxes = found["boxes"]
    assert isinstance(boxes, Solids)
    assert boxes.positions.tolist() == [[1, 2, 3], [1, 2, 3]]
    display.take(single_of(marker(0, ns="", action=int(Action.DELETE_ALL)), little=little))
    assert display.draw(0) == {}


def test_the_array_is_heard_on_the_topic_beside_and_every_message_counts():
    main, array = MarkerDisplay.TOPICS
    assert (main.types, array.types) == (
        ("visualization_msgs/msg/Marker",),
        ("visualization_msgs/msg/MarkerArray",),
    )
    assert array.beside == "_array"
    assert not main.newest_only
    assert not array.newest_only


def test_many_single_markers_are_one_batch():
    display = MarkerDisplay(TYPES)
    for number in range(50):
        display.take(single_of(marker(Kind.CUBE, number)))
    [boxes] = shapes_in(display.draw(0)).values()
    assert isinstance(boxes, Solids)
    assert len(boxes.positions) == 50
