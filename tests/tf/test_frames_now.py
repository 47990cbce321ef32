from studio.tf.buffer import TransformBuffer
from tests.support.transforms import Told, columns


def test_the_root_of_the_largest_tree_is_the_same_whichever_came_first():
    large = [Told("odom", "base"), Told("base", "arm"), Told("arm", "tip")]
    small = [Told("map", "goal"), Told("goal", "near")]
    for rows in ([*large, *small], [*small, *large[::-1]]):
        buffer = TransformBuffer()
        buffer.put(columns(*rows), static=True)
        assert buffer.all_in("mop").root_of_most() == "odom"


def test_of_trees_that_are_as_large_the_first_by_name_is_taken():
    buffer = TransformBuffer()
    buffer.put(columns(Told("b", "c"), Told("a", "d")), static=True)
    assert buffer.all_in("mop").root_of_most() == "a"


def test_without_any_frame_there_is_no_root():
    assert TransformBuffer().all_in("map").root_of_most() == ""
