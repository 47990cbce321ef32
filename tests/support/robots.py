"""Small robots for tests of the scene."""

from __future__ import annotations

from studio.robot.values import (
    Box,
    Collision,
    Cylinder,
    Geometry,
    Inertial,
    Joint,
    JointType,
    Limit,
    Link,
    Material,
    Mimic,
    Origin,
    Robot,
    Sphere,
    Vector3,
    Visual,
)

GREY, DARK, AMBER, BLUE, WHITE = (
    Material(name, rgba)
    for name, rgba in {
        "grey": (0.30, 0.34, 0.41, 1.0),
        "dark": (0.10, 0.11, 0.13, 1.0),
        "amber": (0.98, 0.75, 0.18, 1.0),
        "blue": (0.05, 0.55, 0.75, 1.0),
        "white": (0.80, 0.83, 0.88, 1.0),
    }.items()
)


def body(name: str, geometry: Geometry, material: Material, at: Vector3 = (0, 0, 0)) -> Link:
    """A link of one geometry that is its collision too."""
    origin = Origin(at)
    return Link(
        name,
        (Visual(origin, geometry, material),),
        (Collision(origin, geometry),),
        Inertial(origin, 1.0, ixx=0.01, iyy=0.02, izz=0.02),
    )


def robot_of(links: list[Link], joints: list[Joint]) -> Robot:
    return Robot("test", {link.name: link for link in links}, {one.name: one for one in joints})


def rover(wheel_radius_m: float = 0.105) -> Robot:
    """A four-wheeled rover with a mast and a two-joint arm, a slide and a follower."""
    up = (0.0, 0.0, 0.23)
    links = [
        Link("base_footprint"),
        body("base_link", Box((0.62, 0.40, 0.14)), GREY, up),
        body("deck", Box((0.60, 0.38, 0.02)), AMBER),
        body("mast", Cylinder(0.018, 0.34), WHITE, (0, 0, 0.17)),
        body("camera", Box((0.05, 0.12, 0.05)), DARK),
        body("lidar", Cylinder(0.055, 0.06), BLUE),
        body("shoulder", Cylinder(0.05, 0.08), DARK, (0, 0, 0.04)),
        body("upper arm", Box((0.05, 0.05, 0.28)), AMBER, (0, 0, 0.14)),
        body("forearm", Box((0.04, 0.04, 0.24)), WHITE, (0, 0, 0.12)),
        body("finger/left", Sphere(0.025), DARK),
        body("finger/right", Sphere(0.025), DARK),
    ]
    y, z = (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
    swing = Limit(-1.5, 1.5)
    joints = [
        Joint("base", JointType.FIXED, "base_footprint", "base_link"),
        Joint("deck", JointType.FIXED, "base_link", "deck", Origin((0, 0, 0.31))),
        Joint("mast", JointType.FIXED, "deck", "mast", Origin((-0.2, 0.1, 0.01))),
        Joint("camera", JointType.REVOLUTE, "mast", "camera", Origin((0, 0, 0.36)), z, swing),
        Joint("lidar", JointType.FIXED, "deck", "lidar", Origin((0.05, -0.08, 0.04))),
        Joint("turn", JointType.CONTINUOUS, "deck", "shoulder", Origin((0.2, 0, 0.01)), z),
        Joint("lift", JointType.REVOLUTE, "shoulder", "upper arm", Origin((0, 0, 0.08)), y, swing),
        Joint("bend", JointType.REVOLUTE, "upper arm", "forearm", Origin((0, 0, 0.28)), y, swing),
        Joint(
            "grip",
            JointType.PRISMATIC,
            "forearm",
            "finger/left",
            Origin((0, 0.03, 0.26)),
            y,
            Limit(0.0, 0.05),
        ),
        Joint(
            "follow",
            JointType.PRISMATIC,
            "forearm",
            "finger/right",
            Origin((0, -0.03, 0.26)),
            y,
            Limit(-0.05, 0.05),
            Mimic("grip", -1.0),
        ),
    ]
    for index, (x, side) in enumerate(((0.2, 1), (0.2, -1), (-0.2, 1), (-0.2, -1))):
        name = f"wheel_{index}"
        tyre = Cylinder(wheel_radius_m, 0.07)
        hub = Cylinder(wheel_radius_m / 2, 0.074)
        sideways = Origin((0, 0, 0), (1.5708, 0, 0))
        links.append(
            Link(
                name,
                (Visual(sideways, tyre, DARK), Visual(sideways, hub, WHITE)),
                (Collision(sideways, tyre),),
            )
        )
        place = Origin((x, side * 0.24, wheel_radius_m))
        joints.append(Joint(name, JointType.CONTINUOUS, "base_link", name, place, y))
    return robot_of(links, joints)
