from __future__ import annotations

from studio.tf.buffer import TransformBuffer
from tests.support.transforms import S, Told, columns


def test_the_names_are_the_same_object_until_an_edge_comes_or_goes():
    buffer = TransformBuffer()
    buffer.put(columns(Told("a", "b", S), Told("b", "c", S)))
    names = buffer.all_in("a").names
    buffer.put(columns(Told("a", "b", 2 * S)))
    assert buffer.all_in("b").names is names
    assert buffer.all_in("c", S).names is names
    buffer.put(columns(Told("c", "d", 2 * S)))
    assert set(buffer.all_in("a").names) == {"a", "b", "c", "d"}
    buffer.drop(["b"])
    assert set(buffer.all_in("c").names) == {"b", "c", "d"}


def test_a_frame_is_found_by_its_name():
    buffer = TransformBuffer()
    buffer.put(columns(Told("a", "b", S, (1.0, 2.0, 3.0)), Told("x", "y", S)))
    frames = buffer.all_in("a")
    assert frames.pose_of("b") == (1, 0, 0, 0, 1, 2, 3)
    assert frames.pose_of("a") == (1, 0, 0, 0, 0, 0, 0)
    assert frames.pose_of("y") is frames.pose_of("nowhere") is None
    assert buffer.all_in("nowhere").pose_of("nowhere") == (1, 0, 0, 0, 0, 0, 0)


def test_each_frame_names_its_parent_by_its_row():
    buffer = TransformBuffer()
    edges = {"b": "a", "c": "a", "d": "c", "y": "x"}
    buffer.put(columns(*(Told(parent, child, S) for child, parent in edges.items())))
    frames = buffer.all_in("d")
    found: dict[str, str] = {
        name: frames.names[parent]
        for name, parent in zip(frames.names, frames.parents.tolist(), strict=True)
        if parent >= 0
    }
    assert found == edges


def test_a_time_that_some_do_not_know_breaks_their_connection_only():
    buffer = TransformBuffer()
    for at in range(1, 9):
        buffer.put(columns(Told("map", "odom", at * S), Told("base", "arm", at * S)))
    for at in range(1, 5):
        buffer.put(columns(Told("odom", "base", at * S, (1.0, 0.0, 0.0))))
    for asked_ns, known in ((3 * S + 1, True), (6 * S + 1, False), (3 * S + 1, True)):
        frames = buffer.all_in("map", asked_ns)
        connected = dict(zip(frames.names, frames.connected.tolist(), strict=True))
        assert connected == {"map": True, "odom": True, "base": known, "arm": known}
    frames = buffer.all_in("arm", 6 * S)
    connected = dict(zip(frames.names, frames.connected.tolist(), strict=True))
    assert connected == {"map": False, "odom": False, "base": True, "arm": True}


def test_many_fixed_frames_in_turn_have_their_own_ages():
    buffer = TransformBuffer()
    names = [f"f{number}" for number in range(30)]
    buffer.put(columns(*(Told("map", name, S, (1.0, 0.0, 0.0)) for name in names)))
    for name in (*names, *names):
        frames = buffer.all_in(name)
        assert frames.wxyz_xyz[frames.names.index(name), 4] == 0.0
        assert frames.wxyz_xyz[frames.names.index("map"), 4] == -1.0
        assert frames.ages_s[frames.names.index(name)] == 0.0
