from studio.live.connection.topic_kinds import carried_types, kind_for
from tests.support.graph_ends import publisher as end

IMU, SCAN = "sensor_msgs/msg/Imu", "sensor_msgs/msg/LaserScan"
TEXT = "std_msgs/msg/String"


def test_whoever_subscribes_with_another_type_does_not_change_what_a_topic_carries():
    assert carried_types([end(SCAN)], [end(IMU), end(SCAN)]) == (SCAN,)
    assert carried_types([end(SCAN), end(IMU)], []) == (IMU, SCAN)


def test_of_a_topic_that_nobody_publishes_it_is_told_what_is_wished_for():
    assert carried_types([], [end(SCAN), end(IMU)]) == (IMU, SCAN)
    assert carried_types([], []) == ()


def test_the_display_that_shows_a_topic_hangs_on_its_types_and_of_texts_on_its_name():
    assert kind_for("/scan", (SCAN,)) == "LaserScan"
    assert kind_for("/scan", (TEXT, SCAN)) == "LaserScan"
    assert kind_for("/robot_description", (TEXT,)) == "RobotModel"
    assert kind_for("/chatter", (TEXT,)) == ""
