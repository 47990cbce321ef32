from __future__ import annotations

from pathlib import Path

import pytest

from studio.errors import InterfaceTextError, RosNameError, UnknownTypeError
from studio.ros.profiles import PROFILES
from studio.ros.types.classes import definition_of
from studio.ros.types.definitions import Service
from studio.ros.types.files import InterfaceTexts
from studio.ros.types.library import TypeLibrary


@pytest.fixture
def library() -> TypeLibrary:
    return TypeLibrary("jazzy")


@pytest.mark.parametrize("distro", PROFILES)
def test_every_type_that_a_distribution_names_can_be_made_unless_a_part_is_missing(distro: str):
    library = TypeLibrary(distro)
    makers = {"msg": library.message, "srv": library.service, "action": library.action}
    missing: list[str] = []
    for name in library.names():
        try:
            makers[name.split("/")[1]](name)
        except UnknownTypeError as error:
            missing.append(str(error))
    assert len(library.names()) > 230
    assert missing == []


def test_a_type_has_one_class(library: TypeLibrary):
    assert library.message("std_msgs/msg/Header") is library.message("std_msgs/msg/Header")


def test_a_pasted_text_is_usable_at_once(library: TypeLibrary):
    before = library.generation
    library.add_texts({"my_pkg/msg/Telemetry": "float64 volts 12.5\ngeometry_msgs/Point where"})
    made = library.message("my_pkg/msg/Telemetry")()
    assert made.volts == 12.5
    assert made.where == library.message("geometry_msgs/msg/Point")()
    assert library.hash_of("my_pkg/msg/Telemetry").startswith("RIHS01_")
    assert "my_pkg/msg/Telemetry" in library.names()
    assert library.generation > before


def test_a_text_may_be_changed_and_pasted_again(library: TypeLibrary):
    library.add_texts({"my_pkg/msg/T": "int8 a"})
    first = library.message("my_pkg/msg/T")
    library.add_texts({"my_pkg/msg/T": "int8 b"})
    assert library.message("my_pkg/msg/T") is not first
    assert library.message("my_pkg/msg/T")(b=3).b == 3


def test_what_is_missing_is_named_and_may_come_later(library: TypeLibrary):
    library.add_texts({"my_pkg/msg/Outer": "late_pkg/Inner x"})
    with pytest.raises(UnknownTypeError, match=r"its field x is a .late_pkg/msg/Inner"):
        library.message("my_pkg/msg/Outer")
    library.add_texts({"late_pkg/msg/Inner": "int8 y"})
    assert library.message("my_pkg/msg/Outer")().x.y == 0


def test_services_and_actions_have_all_their_parts(library: TypeLibrary):
    service = library.service("example_interfaces/srv/AddTwoInts")
    assert service.Request(a=1, b=2).a == 1
    assert definition_of(service.Event).name == "example_interfaces/srv/AddTwoInts_Event"
    action = library.action("example_interfaces/action/Fibonacci")
    assert action.SendGoal.Request(goal=action.Goal(order=5)).goal.order == 5
    assert action.GetResult.Response().result == action.Result()
    assert action.FeedbackMessage().feedback == action.Feedback()
    assert isinstance(library.interface("std_srvs/srv/Empty"), Service)


def test_defaults_of_common_messages_are_known(library: TypeLibrary):
    assert library.message("geometry_msgs/msg/Pose")().orientation.w == 1.0


def test_unknown_types_say_what_to_do(library: TypeLibrary):
    with pytest.raises(UnknownTypeError, match="--interfaces"):
        library.message("no_pkg/msg/Thing")
    with pytest.raises(UnknownTypeError):
        library.service("std_msgs/msg/String")


@pytest.mark.parametrize(
    ("texts", "sentence"),
    [
        ({"p/msg/A": "A a"}, "part of itself"),
        ({"p/msg/A": "B[] b", "p/msg/B": "A[] a"}, "part of itself"),
        ({"p/msg/A": "float64[4000000000] x"}, "more than 16000000 values"),
        ({"p/msg/A": "B[4000] b", "p/msg/B": "C[4000] c", "p/msg/C": "int8[9] x"}, "more than"),
        ({"p/msg/A": "string[5000] x"}, "use a sequence"),
        ({f"p/msg/A{i}": f"A{i + 1} a" for i in range(40)}, "deeper than 32"),
    ],
)
def test_hostile_types_are_refused_and_nothing_is_kept(
    library: TypeLibrary, texts: dict[str, str], sentence: str
):
    if "p/msg/A39" in texts:
        texts = {**texts, "p/msg/A40": "int8 x"}
    with pytest.raises(InterfaceTextError, match=sentence):
        library.add_texts(texts)
    assert not [name for name in library.names() if name.startswith("p/")]


def test_types_that_nodes_live_by_cannot_be_redefined(library: TypeLibrary):
    with pytest.raises(InterfaceTextError, match="speak another form"):
        library.add_texts({"builtin_interfaces/msg/Time": "float64 seconds"})
    library.add_texts({"builtin_interfaces/msg/Time": "int32 sec\nuint32 nanosec"})
    assert library.text_of("builtin_interfaces/msg/Time") is not None


def test_a_bad_text_among_good_ones_keeps_all_out(library: TypeLibrary):
    with pytest.raises(InterfaceTextError):
        library.add_texts({"p/msg/Good": "int8 x", "p/msg/Bad": "int8"})
    with pytest.raises(RosNameError):
        library.add_texts({"p/msg/Good": "int8 x", "nonsense": "int8 x"})
    with pytest.raises(UnknownTypeError):
        library.find("p/msg/Good")


def test_of_several_texts_the_sound_ones_are_taken_and_each_other_one_is_told(
    library: TypeLibrary,
):
    good, bad = "p/msg/Good", "p/msg/Bad"
    texts = {
        good: "int8 x",
        bad: "int8 x\nfloat y",
        "p/msg/Loop": "Loop again",
        "p/msg/User": "Good good\nBad bad",
        "p/srv/Ask": "int8 a\n--\nint8 b",
        "builtin_interfaces/msg/Time": "float64 seconds",
    }
    told = library.add_sound_texts(InterfaceTexts(texts, {bad: Path("/ws/p/msg/Bad.msg")}))
    assert str(told.pop(bad)) == (
        '/ws/p/msg/Bad.msg:2: "float" is no type: write float32 or float64.'
    )
    assert set(told) == {"p/msg/Loop", "p/srv/Ask", "builtin_interfaces/msg/Time"}
    assert library.message(good)(x=1).x == 1
    with pytest.raises(UnknownTypeError, match=r"Bad\.msg:2: \"float\" is no type: write"):
        library.hash_of(bad)
    with pytest.raises(UnknownTypeError, match=r"its field bad is .*Bad\.msg:2"):
        library.message("p/msg/User")
    with pytest.raises(UnknownTypeError, match="p/srv/Ask:2"):
        library.message("p/srv/Ask_Request")


def test_a_text_that_was_mended_is_known_and_its_fault_forgotten(library: TypeLibrary):
    library.add_sound_texts(InterfaceTexts({"p/msg/A": "float x"}))
    assert list(library.faults()) == ["p/msg/A"]
    assert library.add_sound_texts(InterfaceTexts({"p/msg/A": "float32 x"})) == {}
    assert library.message("p/msg/A")(x=0.5).x == 0.5
    library.add_sound_texts(InterfaceTexts({"p/msg/A": "float x"}))
    library.add_texts({"p/msg/A": "float64 x"})
    assert library.faults() == {}
