from studio.displays.display import TopicRole
from studio.live.displays.display_list import Listening
from studio.live.displays.ear import Ear, Wish, on_wire, wish_for
from studio.ros.qos import DurabilityPolicy, ReliabilityPolicy
from studio.ros.types.library import TypeLibrary
from tests.support.heard_topics import HeardTopics, publisher

SCAN, IMAGE, SMALL = "sensor_msgs/msg/LaserScan", "sensor_msgs/msg/Image", "std_msgs/msg/Empty"
ROLE = TopicRole("", (SCAN, IMAGE), depth=5)
ANY = Listening()


def test_it_is_listened_to_as_those_publish_who_are_there():
    assert wish_for(ROLE, "/scan", ANY, ()) == Wish("/scan", SCAN, True, False, 5)
    best_effort = publisher(SCAN, reliable=False)
    assert wish_for(ROLE, "/scan", ANY, [publisher(SCAN), best_effort]).reliable is False
    assert wish_for(ROLE, "/scan", ANY, [publisher(SCAN, latched=True), best_effort]).latched
    assert wish_for(ROLE, "/scan", ANY, [publisher(SMALL, latched=True)]).latched is False


def test_what_somebody_chose_holds_within_bounds():
    chosen = Listening(reliable=False, latched=True, depth=1_000_000)
    wish = wish_for(ROLE, "/scan", chosen, [publisher(SCAN)])
    assert wish == Wish("/scan", SCAN, False, True, 1000)
    assert wish_for(ROLE, "/scan", Listening(depth=-3), ()).depth == 1


def test_of_two_types_that_fit_the_choice_does_not_hang_on_who_came_first():
    both = [publisher(IMAGE), publisher(SCAN)]
    assert wish_for(ROLE, "/scan", ANY, both).type_name == SCAN
    assert wish_for(ROLE, "/scan", ANY, both[::-1]).type_name == SCAN


def test_when_all_publishers_are_gone_it_is_listened_to_as_before():
    before = wish_for(ROLE, "/scan", ANY, [publisher(IMAGE, reliable=False, latched=True)])
    assert wish_for(ROLE, "/scan", ANY, (), before) == before


def test_a_topic_is_asked_for_as_wished_until_the_ear_is_closed():
    heard = HeardTopics()
    ear = Ear(heard, Wish("/scan", SCAN, False, True, 7), ROLE)
    ((name, topic, qos),) = heard.asked
    assert (name, topic, qos.depth) == (SCAN, "/scan", 7)
    assert qos.reliability is ReliabilityPolicy.BEST_EFFORT
    assert qos.durability is DurabilityPolicy.TRANSIENT_LOCAL
    heard.say("/scan", b"abc")
    assert [(one.type_name, one.cdr) for one in ear.mailbox.take()] == [(SCAN, b"abc")]
    ear.close()
    assert heard.takers == {}


def test_who_publishes_is_told_with_its_types_and_whether_the_router_is_there():
    types = TypeLibrary("jazzy")
    seen = on_wire(ROLE, [publisher(SMALL), publisher(SCAN)], types, connected=False)
    assert (seen.connected, seen.lost, seen.publishers) == (True, True, 2)
    assert (seen.types, seen.foreign_hash) == ((SMALL, SCAN), False)
