import math

from studio.displays.catalogue import DISPLAYS
from studio.displays.properties import Property
from studio.live.displays.catalogue_views import kind_views, property_view


def test_every_display_is_told_with_its_types_and_settings_in_the_order_of_the_alphabet():
    views = kind_views(DISPLAYS)
    names = [one.kind for one in views]
    assert names == sorted(names, key=str.lower)
    assert set(names) == {one.KIND for one in DISPLAYS}
    scan = next(one for one in views if one.kind == "LaserScan")
    assert scan.types == ("sensor_msgs/msg/LaserScan",)
    assert "Size (m)" in {one.name for one in scan.properties}
    assert next(one for one in views if one.kind == "Grid").types == ()


def test_a_number_without_bounds_is_told_without_them_for_json_has_no_infinity():
    one = Property("Depth", "number", 1.0, "How deep.", high=4.0, when=("Style", ("Deep",)))
    view = property_view(one)
    assert (view.low, view.high) == (None, 4.0)
    assert (view.when, view.when_values) == ("Style", ("Deep",))
    assert all(
        math.isfinite(each)
        for kind in kind_views(DISPLAYS)
        for setting in kind.properties
        for each in (setting.low, setting.high)
        if each is not None
    )
