from __future__ import annotations

import pytest

from studio.errors import UnknownTypeError
from studio.ros.types.definitions import Field, FieldType, Message
from studio.ros.types.library import TypeLibrary
from studio.ros.types.type_hash import closure, type_description, type_hash

# Hashes that others published or printed; of shortened ones head and tail are compared.
GOLDEN = {
    "std_msgs/msg/String": "df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18",
    "std_msgs/msg/Char": "3ad2d04dd29ba19d04b16659afa3ccaedd691914b02a64e82e252f2fa6a586a9",
    "geometry_msgs/msg/Twist": "9c45bf16fe0983d80e3cfe750d6835843d265a9a6c46bd2e609fcddde6fb8d2a",
    "sensor_msgs/msg/BatteryState":
        "4bee5dfce981c98faa6828b868307a0a73f992ed0789f374ee96c8f840e69741",
    "sensor_msgs/msg/Imu": "7d9a00ff131080897a5ec7e26e315954b8eae3353c3f995c55faf71574000b5b",
    "sensor_msgs/msg/JointState":
        "a13ee3a330e346c9d87b5aa18d24e11690752bd33a0350f11c5882bc9179260e",
    "tf2_msgs/msg/TFMessage": "e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087",
    "example_interfaces/srv/AddTwoInts":
        "e118de6bf5eeb66a2491b5bda11202e7b68f198d6f67922cf30364858239c81a",
    "rcl_interfaces/srv/ListParameters":
        "3e6062bfbb27bfb8730d4cef2558221f51a11646d78e7bb30a1e83afac3aad9d",
    "rcl_interfaces/srv/GetParameters": "bf9803d5c74cf989...5cbc",
    "rcl_interfaces/srv/SetParameters": "56eed9a67e169f9c...d7e0",
    "rcl_interfaces/srv/DescribeParameters": "845b484d71eb0673...4cff",
    "rcl_interfaces/srv/GetParameterTypes": "da199c878688b3e5...80ca",
    "rcl_interfaces/srv/SetParametersAtomically": "0e192ef259c07fc3...5fcd",
    "rcl_interfaces/msg/ParameterEvent":
        "043e627780fcad87a22d225bc2a037361dba713fca6a6b9f4b869a5aa0393204",
    "action_msgs/srv/CancelGoal":
        "573d8b0a534451d7bc2ac8c5ffde8ac14b8593b7001175d0cd6516dcbeb8689a",
    "action_msgs/msg/GoalStatusArray":
        "6c1684b00f177d37438febe6e709fc4e2b0d4248dca4854946f9ed8b30cda83e",
    "example_interfaces/action/Fibonacci_SendGoal": "d1a57fb2a4afe8c2...",
    "example_interfaces/action/Fibonacci_GetResult": "1b0de0d5d29dc955...",
    "example_interfaces/action/Fibonacci_FeedbackMessage": "c1de71afd52e49a8...",
    "action_tutorials_interfaces/action/Fibonacci_GetResult":
        "8b47e383f1e31f6d8df6417ab54957e7d5ea24dad315646ad711ac3fdea81d58",
    "lifecycle_msgs/srv/GetState": "800a0a5aae599782...",
    "lifecycle_msgs/srv/ChangeState": "356fe34f0475a43a...",
    "lifecycle_msgs/msg/TransitionEvent": "d5f8873a2f014649...",
    "rosbag2_interfaces/srv/Burst":
        "3cba361b055bbec262593fcb727aeb9fb6d096f70b50e6cd9b548b63296f2380",
    "rosbag2_interfaces/srv/Play":
        "e87b287e52219f5f32127c876a0688c537b8a5762612f33b8e740c3b89d19d2b",
    "std_srvs/srv/Trigger": "eeff2cd6fa5ad9d2...",
    "std_srvs/srv/SetBool": "abe9e4bb6b41b40e...",
    "std_srvs/srv/Empty": "5888399dedec5ccc...",
    "type_description_interfaces/srv/GetTypeDescription":
        "69b9c19c1021405984cc60dbbb1edceb147a6538b411d812ba6afabeed962cd5",
}  # fmt: skip


@pytest.fixture(scope="module")
def jazzy() -> TypeLibrary:
    return TypeLibrary("jazzy")


@pytest.mark.parametrize("name", GOLDEN)
def test_a_type_has_the_hash_that_others_compute(jazzy: TypeLibrary, name: str):
    computed = jazzy.hash_of(name)
    head, _, tail = GOLDEN[name].partition("...")
    assert computed.startswith("RIHS01_" + head)
    assert computed.endswith(tail)
    assert len(computed) == 7 + 64


def test_the_hash_of_a_message_that_changed_is_that_of_the_distribution(jazzy: TypeLibrary):
    changed = "sensor_msgs/msg/Range"
    assert TypeLibrary("humble").hash_of(changed) != jazzy.hash_of(changed)
    assert TypeLibrary("kilted").hash_of(changed) == jazzy.hash_of(changed)


@pytest.mark.parametrize("distro", ["jazzy", "kilted"])
def test_a_transition_event_has_a_number_for_its_time_until_lyrical(distro: str):
    head = GOLDEN["lifecycle_msgs/msg/TransitionEvent"].removesuffix("...")
    assert TypeLibrary(distro).hash_of("lifecycle_msgs/msg/TransitionEvent")[7:].startswith(head)


def test_a_type_without_fields_is_described_with_one():
    described = type_description(Message("p/msg/Empty"), Message)
    (field,) = described["type_description"]["fields"]  # pyright: ignore
    assert field["name"] == "structure_needs_at_least_one_member"


def test_parts_of_parts_are_part_of_the_hash():
    def of(depth: str) -> str:
        parts = {
            "p/msg/B": Message("p/msg/B", (Field("c", FieldType("p/msg/C")),)),
            "p/msg/C": Message("p/msg/C", (Field("x", FieldType(depth)),)),
        }
        top = Message("p/msg/A", (Field("b", FieldType("p/msg/B")),))
        assert set(closure(top, parts.__getitem__)) == {"p/msg/A", "p/msg/B", "p/msg/C"}
        return type_hash(top, parts.__getitem__)

    assert of("int8") != of("int16")


def test_no_hash_is_guessed_when_a_part_is_unknown(jazzy: TypeLibrary):
    jazzy.add_texts({"lone_pkg/msg/Half": "gone_pkg/Other x"})
    with pytest.raises(UnknownTypeError, match="gone_pkg/msg/Other"):
        jazzy.hash_of("lone_pkg/msg/Half")


def test_comments_defaults_and_constants_are_no_part_of_a_hash(jazzy: TypeLibrary):
    jazzy.add_texts({"hash_pkg/msg/A": "int32 x 5 # five\nint32 FIVE=5"})
    first = jazzy.hash_of("hash_pkg/msg/A")
    jazzy.add_texts({"hash_pkg/msg/A": "int32 x"})
    assert jazzy.hash_of("hash_pkg/msg/A") == first
