from studio.displays.markers.display import MarkerArrayDisplay
from studio.displays.markers.kinds import Kind
from tests.support.markers import TYPES, array_of, marker, shapes_in


def test_markers_that_an_array_does_not_name_stay():
    display = MarkerArrayDisplay(TYPES)
    display.take(array_of(marker(Kind.CUBE, 0)))
    display.take(array_of(marker(Kind.SPHERE, 1)))
    assert list(shapes_in(display.draw(0))) == ["boxes", "balls"]
    display.take(array_of())
    assert list(shapes_in(display.draw(0))) == ["boxes", "balls"]


def test_every_array_counts_and_those_from_before_are_asked_for():
    [topic] = MarkerArrayDisplay.TOPICS
    assert topic.types == ("visualization_msgs/msg/MarkerArray",)
    assert topic.latched
    assert not topic.newest_only
