# pyright: basic, reportAttributeAccessIssue=false
"""A second opinion on a URDF, on lxml and numpy alone: `independent_checks.py FILE FOLDER`."""

import sys
from collections.abc import Iterator
from pathlib import Path
from urllib.parse import unquote

import numpy as np
from lxml import etree


def packages(folder: Path) -> dict[str, list[Path]]:
    found = dict[str, list[Path]]()
    for manifest in folder.rglob("package.xml"):
        found.setdefault(etree.parse(manifest).findtext("name").strip(), []).append(manifest.parent)
    return found


def missing_meshes(robot: etree.Element, file: Path, known: dict[str, list[Path]]) -> set[str]:
    uris = {mesh.get("filename").strip() for mesh in robot.iterfind("link//geometry/mesh")}
    return {uri for uri in uris if not any(one.is_file() for one in places(uri, file, known))}


def places(uri: str, file: Path, known: dict[str, list[Path]]) -> list[Path]:
    scheme, _, rest = unquote(uri).rpartition("://")
    name, _, inside = rest.partition("/")
    if scheme in {"package", "model"}:
        return [folder / inside for folder in known.get(name, [])]
    own = [folder / rest for folder in file.parents if (folder / "package.xml").is_file()]
    return [Path(rest)] if scheme else [file.parent / rest, *own[:1]]


def root_faults(robot: etree.Element) -> set[str]:
    links = {link.get("name") for link in robot.iterfind("link")}
    ends = [[j.find(e).get("link") for e in ("child", "parent")] for j in robot.iterfind("joint")]
    parents = {child: parent for child, parent in ends if {child, parent} <= links}
    roots = reached = links - parents.keys()
    while more := {child for child, parent in parents.items() if parent in reached} - reached:
        reached = reached | more
    faults = {"no-links": not links, "several-roots": len(roots) > 1, "cycle": reached != links}
    return {name for name, is_so in faults.items() if is_so}


def inertia_faults(robot: etree.Element) -> Iterator[tuple[str, str]]:
    for link in robot.iterfind("link[inertial]"):
        i = {key: float(text) for key, text in link.find("inertial/inertia").items()}
        tensor = [[i["i" + "".join(sorted(row + column))] for column in "xyz"] for row in "xyz"]
        a, b, c = sorted(np.linalg.eigvals(tensor).real)
        slack = 1e-6 * max(abs(a), abs(c))
        light = float(link.find("inertial/mass").get("value")) <= 0
        found = [(light, "bad-mass"), (a <= slack, "bad-inertia"), (c > a + b + slack, "triangle")]
        yield from [(link.get("name"), fault) for is_so, fault in found if is_so][:1]


if __name__ == "__main__":
    whole, below = etree.parse(sys.argv[1]).getroot(), packages(Path(sys.argv[2]))
    sys.stdout.write(f"{missing_meshes(whole, Path(sys.argv[1]).absolute(), below)}\n")
    sys.stdout.write(f"{root_faults(whole)}\n{[*inertia_faults(whole)]}\n")
