"""The messages that rosidl makes of a service or an action beside those in its text."""

from __future__ import annotations

from studio.ros.types.definitions import Action, Field, FieldType, Message, Service, Shape

EVENT_INFO = "service_msgs/msg/ServiceEventInfo"
_UUID = FieldType("unique_identifier_msgs/msg/UUID")
_TIME = FieldType("builtin_interfaces/msg/Time")


def event_of(service: Service) -> Message:
    """Make the message of a service's introspection topic, `T_Event`."""
    return Message(
        f"{service.name}_Event",
        (
            Field("info", FieldType(EVENT_INFO)),
            Field("request", FieldType(service.request.name, Shape.BOUNDED, 1)),
            Field("response", FieldType(service.response.name, Shape.BOUNDED, 1)),
        ),
    )


def whole_of(service: Service) -> Message:
    """Make the type that a service's hash is taken of; nobody sends it."""
    return Message(
        service.name,
        (
            Field("request_message", FieldType(service.request.name)),
            Field("response_message", FieldType(service.response.name)),
            Field("event_message", FieldType(f"{service.name}_Event")),
        ),
    )


def send_goal_of(action: Action) -> Service:
    """Make the service that asks for a goal."""
    name = f"{action.name}_SendGoal"
    return Service(
        name,
        Message(
            f"{name}_Request",
            (Field("goal_id", _UUID), Field("goal", FieldType(action.goal.name))),
        ),
        Message(
            f"{name}_Response",
            (Field("accepted", FieldType("bool")), Field("stamp", _TIME)),
        ),
    )


def get_result_of(action: Action) -> Service:
    """Make the service that waits for a goal's end."""
    name = f"{action.name}_GetResult"
    return Service(
        name,
        Message(f"{name}_Request", (Field("goal_id", _UUID),)),
        Message(
            f"{name}_Response",
            (
                Field("status", FieldType("int8")),
                Field("result", FieldType(action.result.name)),
            ),
        ),
    )


def feedback_message_of(action: Action) -> Message:
    """Make the message of an action's feedback topic."""
    return Message(
        f"{action.name}_FeedbackMessage",
        (Field("goal_id", _UUID), Field("feedback", FieldType(action.feedback.name))),
    )


def whole_of_action(action: Action) -> Message:
    """Make the type that an action's own hash is taken of; nobody sends it."""
    parts = {
        "goal": f"{action.name}_Goal",
        "result": f"{action.name}_Result",
        "feedback": f"{action.name}_Feedback",
        "send_goal_service": f"{action.name}_SendGoal",
        "get_result_service": f"{action.name}_GetResult",
        "feedback_message": f"{action.name}_FeedbackMessage",
    }
    return Message(action.name, tuple(Field(name, FieldType(part)) for name, part in parts.items()))
