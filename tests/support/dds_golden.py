"""`python -m tests.support.dds_golden [FOLDER]`: writes `tests/golden/dds_bridge/`, JSON lines.

What the real bridge shows on Zenoh of a robot on DDS, and what it answers: tokens, its admin
space, samples, and queries both ways, to services and to actions. Each line says `what` it is;
payloads and attachments are in hexadecimal. Names of this machine are replaced.
"""

from __future__ import annotations

import json
import sys
from collections import Counter
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import zenoh

from studio.ros.action.protocol import ANY_GOAL, goal_id_message
from studio.ros.cdr import codec_of
from studio.ros.messages import types_of
from studio.ros.wire.zenoh import admin_answers, close, declare_token, live_tokens
from tests.support.dds_bridge import DdsNetwork, session_at
from tests.support.wire import wait_until

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.ros.types.classes import MessageValue
    from tests.support.dds_bridge import Bridge, DdsRobot

FOLDER: Final = Path(__file__).parents[1] / "golden" / "dds_bridge"
SESSIONS: Final = {
    "jazzy": ("jazzy", "/"),
    "humble": ("humble", "/"),
    "namespace": ("jazzy", "/robot1"),
}
"""By the name of the file: the distribution, and the namespace of the bridge."""
_OF_MACHINE: Final = {
    "__Hostname": "robot",
    "__NetworkAddresses": "udp/127.0.0.1:7412@1",
    "__Pid": "1",
    "__ProcessName": "robot",
}
_SAMPLES_EACH: Final = 3
_ASK_S: Final = 3.0
_ADD: Final = "example_interfaces/srv/AddTwoInts"
_FIBONACCI: Final = "example_interfaces/action/Fibonacci"
_TEXT: Final = "std_msgs/msg/String"
_GOAL: Final = bytes(range(1, 17))


class Recorder:
    """A bare client of Zenoh, which writes down what it sees."""

    def __init__(self, bridge: Bridge, distro: str, namespace: str) -> None:
        self.lines: list[dict[str, Any]] = []
        self.types = types_of(distro)
        self._prefix = f"{namespace.strip('/')}/".lstrip("/")
        self._session: Any = session_at(bridge.endpoint)
        self._zid = str(self._session.info.zid())
        self._seen: Counter[str] = Counter()
        self._kept: list[Any] = []
        self.say("session", bridge=bridge.zid, zid=self._zid, distro=distro, namespace=namespace)

    def say(self, what: str, **values: object) -> None:
        """Write a line."""
        self.lines.append({"what": what, **values})

    def close(self) -> None:
        """Hang up."""
        close(self._session)

    def tokens(self) -> set[str]:
        """Tokens of bridges that are alive."""
        return set(live_tokens(self._session, "@/*/@ros2_lv/**", _ASK_S))

    def record_tokens(self) -> None:
        """Write down all tokens, and those of publishers that keep samples."""
        for token in sorted(self.tokens()):
            self.say("token", key=token)
        for token in sorted(live_tokens(self._session, "**/@adv/**", _ASK_S)):
            self.say("adv_token", key=token)

    def record_admin(self, below: str) -> None:
        """Write down what the admin space says."""
        for key, answer in sorted(admin_answers(self._session, f"@/*/ros2/{below}", _ASK_S)):
            self.say("admin", key=key, value=_cleaned(json.loads(answer)))

    def subscribe(self) -> None:
        """Write down the first samples of each key from now on."""
        subscriber = self._session.declare_subscriber(
            "**", self._hear, allowed_origin=zenoh.Locality.REMOTE
        )
        self._kept.append(subscriber)

    def heard(self, name: str) -> int:
        """How many samples came on a topic."""
        return self._seen[self._prefix + name]

    def record_history(self, name: str) -> None:
        """Write down what a publisher keeps for those who come late."""
        key = f"{self._prefix}{name}"
        for sample in self._replies(f"{key}/@adv/**", None, zenoh.ReplyKeyExpr.ANY):
            self.say("history", selector=f"{key}/@adv/**", **_told(sample))

    def call(self, name: str, request: MessageValue) -> None:
        """Ask a service of the robot, and write down the reply."""
        key, payload = f"{self._prefix}{name}", bytes(codec_of(type(request)).encode(request))
        self.say("get", key=key, payload=payload.hex())
        for sample in self._replies(key, payload):
            self.say("reply", **_told(sample))

    def announce(self, kind: str, name: str, type_name: str, qos: str = "") -> None:
        """Declare a token, as another bridge would."""
        name, type_name = (text.replace("/", "§") for text in (self._prefix + name, type_name))
        whole = f"@/{self._zid}/@ros2_lv/{kind}/{name}/{type_name}{qos}"
        self._kept += [
            declare_token(self._session, one) for one in (f"@/{self._zid}/@ros2_lv", whole)
        ]
        self.say("declared", key=whole)

    def serve(self, name: str, response: MessageValue) -> None:
        """Answer what the robot asks, always the same, and write down its queries."""
        payload = bytes(codec_of(type(response)).encode(response))
        key = f"{self._prefix}{name}"

        def answer(query: Any) -> None:  # noqa: ANN401
            attachment = None if query.attachment is None else query.attachment.to_bytes().hex()
            asked = b"" if query.payload is None else query.payload.to_bytes()
            self.say(
                "query", key=str(query.key_expr), payload=asked.hex(), attachment=attachment,
                answer=payload.hex(),
            )  # fmt: skip
            query.reply(key, payload)

        self._kept.append(self._session.declare_queryable(key, answer))

    def put(self, name: str, message: MessageValue) -> None:
        """Publish to the robot."""
        payload = bytes(codec_of(type(message)).encode(message))
        self.say("put", key=self._prefix + name, payload=payload.hex())
        self._session.put(self._prefix + name, payload)

    def _replies(
        self,
        selector: str,
        payload: bytes | None,
        accepted: zenoh.ReplyKeyExpr = zenoh.ReplyKeyExpr.MATCHING_QUERY,
    ) -> Iterator[Any]:
        found: Any = self._session.get(
            selector, payload=payload, timeout=_ASK_S, accept_replies=accepted
        )
        for reply in found:
            if reply.ok is not None:
                yield reply.ok

    def _hear(self, sample: Any) -> None:  # noqa: ANN401
        key = str(sample.key_expr)
        self._seen[key] += 1
        if self._seen[key] <= _SAMPLES_EACH:
            priority, congestion = str(sample.priority), str(sample.congestion_control)
            self.say("sample", **_told(sample), priority=priority, congestion=congestion)


def _told(sample: Any) -> dict[str, Any]:  # noqa: ANN401
    return {
        "key": str(sample.key_expr),
        "payload": sample.payload.to_bytes().hex(),
        "encoding": str(sample.encoding),
        "attachment": None if sample.attachment is None else sample.attachment.to_bytes().hex(),
        "timestamp": None if sample.timestamp is None else str(sample.timestamp),
    }


def _cleaned(value: Any) -> Any:  # noqa: ANN401
    """Replace what names this machine."""
    if isinstance(value, dict):
        found: dict[str, Any] = value  # pyright: ignore[reportUnknownVariableType]
        return {key: _OF_MACHINE.get(key, _cleaned(one)) for key, one in found.items()}
    return value


def _build(robot: DdsRobot) -> None:
    """A robot with one of each kind of end."""
    latched, best_effort = (
        {"durability": "transient_local", "depth": 1},
        {"reliability": "best_effort"},
    )
    say = {"type_name": _TEXT, "values": {"data": "hello"}}
    robot.ask("publish", topic="/chatter", **say, rate_hz=20)
    robot.ask("publish", topic="/robot_note", **say, qos=latched)
    robot.ask("publish", topic="/events", **say, qos={"history": "keep_all"}, rate_hz=20)
    scan = {"ranges": [1.0, 2.0], "header": {"frame_id": "laser"}}
    robot.ask(
        "publish", topic="/scan", type_name="sensor_msgs/msg/LaserScan", values=scan, rate_hz=20,
        qos=best_effort, node="/front/laser",
    )  # fmt: skip
    robot.ask("subscribe", topic="/back", type_name=_TEXT)
    robot.ask("subscribe", topic="/from_zenoh", type_name=_TEXT)
    robot.ask("serve", service="/add_two_ints", type_name=_ADD, behaviour="add")
    robot.ask("serve", service="/reset", type_name="std_srvs/srv/Trigger", behaviour="agree")
    robot.ask("call", service="/add_remote", type_name=_ADD, values={"a": 1, "b": 2})
    robot.ask("serve_fibonacci")
    robot.ask("send_goal", action="/remote_fibonacci", goal={"order": 3})
    robot.ask("parameters", values={"speed": 1.5}, node="/front/laser")


def _ask_the_robot(recorder: Recorder, robot: DdsRobot) -> None:
    """What another bridge's side would send to it."""
    types = recorder.types
    add = types.service(_ADD).Request
    recorder.call("add_two_ints", add(a=2, b=40))
    recorder.call("add_two_ints", add(a=-7, b=3))
    recorder.call("reset", types.service("std_srvs/srv/Trigger").Request())
    names = types.service("rcl_interfaces/srv/GetParameters").Request(names=["speed"])
    recorder.call("front/laser/get_parameters", names)
    action = types.action(_FIBONACCI)
    goal_id = goal_id_message(types, _GOAL)
    goal = action.SendGoal.Request(goal_id=goal_id, goal=action.Goal(order=4))
    recorder.call("fibonacci/_action/send_goal", goal)
    recorder.call("fibonacci/_action/get_result", action.GetResult.Request(goal_id=goal_id))
    cancel: Any = types.service("action_msgs/srv/CancelGoal").Request()
    cancel.goal_info.goal_id = goal_id_message(types, ANY_GOAL)
    recorder.call("fibonacci/_action/cancel_goal", cancel)
    text = types.message(_TEXT)
    recorder.put("back", text(data="to the robot"))
    robot.wait_heard("/back", data="to the robot")
    recorder.announce("MP", "from_zenoh", _TEXT, "/:::")

    def is_routed() -> bool:
        recorder.put("from_zenoh", text(data="of Zenoh alone"))
        recorder.lines.pop()
        return bool(robot.all_said("heard", topic="/from_zenoh"))

    wait_until("the robot hears what only Zenoh has", is_routed)


def _answer_the_robot(recorder: Recorder, robot: DdsRobot) -> None:
    """What its clients ask others for."""
    types = recorder.types
    recorder.serve("add_remote", types.service(_ADD).Response(sum=3))
    recorder.announce("SS", "add_remote", _ADD)
    assert robot.wait_said("answered", service="/add_remote")["response"] == {"sum": 3}
    action = types.action(_FIBONACCI)
    parts = (
        ("send_goal", action.SendGoal.Response(accepted=True)),
        ("get_result", action.GetResult.Response(status=4, result=action.Result(sequence=[0, 1]))),
        ("cancel_goal", types.service("action_msgs/srv/CancelGoal").Response()),
    )
    for part, response in parts:
        recorder.serve(f"remote_fibonacci/_action/{part}", response)
    recorder.announce("AS", "remote_fibonacci", _FIBONACCI)
    robot.wait_said("result", action="/remote_fibonacci", status="SUCCEEDED")


def record(distro: str, namespace: str) -> list[dict[str, Any]]:
    """Have a robot and a bridge, and write down all that they show."""
    with ExitStack() as stack:
        network = stack.enter_context(DdsNetwork())
        bridge = network.bridge(distro=distro, namespace=namespace)
        robot = network.robot(distro=distro)
        recorder = Recorder(bridge, distro, namespace)
        stack.callback(recorder.close)
        _build(robot)
        last = "front§laser§set_parameters_atomically"
        wait_until("all is shown", lambda: any(last in one for one in recorder.tokens()))
        recorder.record_tokens()
        recorder.record_admin("**")
        recorder.subscribe()
        for name in ("chatter", "events", "scan"):
            wait_until(name, lambda name=name: recorder.heard(name) >= _SAMPLES_EACH)
        wait_until("the note", lambda: recorder.heard("robot_note") > 0)
        recorder.record_history("robot_note")
        _ask_the_robot(recorder, robot)
        _answer_the_robot(recorder, robot)
        recorder.record_admin("route/**")
        before = recorder.tokens()
        assert robot.end() == 0
        recorder.say("robot_left")
        wait_until("it is gone", lambda: len(recorder.tokens()) < len(before) / 2)
        for token in sorted(before - recorder.tokens()):
            recorder.say("token_gone", key=token)
        return recorder.lines


def main(folder: Path) -> None:
    """Write a file for each session."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, (distro, namespace) in SESSIONS.items():
        lines = [json.dumps(one, ensure_ascii=False) for one in record(distro, namespace)]
        (folder / f"{name}.jsonl").write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else FOLDER)
