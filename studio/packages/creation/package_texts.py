"""The files of a new package, as `ros2 pkg create` lays them out and colcon builds them."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Final
from xml.sax.saxutils import escape, quoteattr

from studio.packages.creation.licenses import known_license, license_text
from studio.packages.sources.interfaces import PACKAGE_NEEDS

if TYPE_CHECKING:
    from studio.packages.creation.new_package import NewPackage

_PYTHON_LINTERS: Final = ("ament_copyright", "ament_flake8", "ament_pep257", "python3-pytest")
_CMAKE_LINTERS: Final = ("ament_lint_auto", "ament_lint_common")


def package_files(new: NewPackage) -> dict[str, str]:
    """Return the texts of all files by their paths below the folder, in the order of making.

    The package's wishes were checked by `new_package.faults`.
    """
    found = {"package.xml": package_xml(new)}
    if new.is_python:
        found |= _python_files(new)
    else:
        found |= _cmake_files(new)
    if spdx := known_license(new.license):
        year = time.gmtime().tm_year
        found["LICENSE"] = license_text(spdx, new.maintainer_name, year)
    return found


def package_folders(new: NewPackage) -> tuple[str, ...]:
    """Return the folders that a new package has, even if they are empty."""
    if new.is_python:
        return (new.name, "resource", "test")
    return (f"include/{new.name}", "src")


def package_xml(new: NewPackage) -> str:
    """Return the text of its package.xml."""
    schema = f"http://download.ros.org/schema/package_format{new.package_format}.xsd"
    license_name = known_license(new.license) or new.license
    lines = [
        '<?xml version="1.0"?>',
        f'<?xml-model href="{schema}" schematypens="http://www.w3.org/2001/XMLSchema"?>',
        f'<package format="{new.package_format}">',
        f"  <name>{new.name}</name>",
        f"  <version>{new.version}</version>",
        f"  <description>{escape(new.description)}</description>",
        f"  <maintainer email={quoteattr(new.maintainer_email)}>"
        f"{escape(new.maintainer_name)}</maintainer>",
        f"  <license>{escape(license_name)}</license>",
    ]
    if not new.is_python:
        lines += ["", _element("buildtool_depend", new.build_type)]
    generators, runtime, group = (_element(*one) for one in PACKAGE_NEEDS)
    if new.has_interfaces:
        lines += [generators]
    if new.dependencies:
        lines += ["", *(_element("depend", one) for one in new.dependencies)]
    if new.has_interfaces:
        lines += ["", runtime]
    linters = {"ament_python": _PYTHON_LINTERS, "ament_cmake": _CMAKE_LINTERS}
    if tests := linters.get(new.build_type):
        lines += ["", *(_element("test_depend", one) for one in tests)]
    if new.has_interfaces:
        lines += ["", group]
    lines += [
        "",
        "  <export>",
        f"    <build_type>{new.build_type}</build_type>",
        "  </export>",
        "</package>",
    ]
    return "\n".join(lines) + "\n"


def _element(tag: str, text: str) -> str:
    return f"  <{tag}>{text}</{tag}>"


def _python_files(new: NewPackage) -> dict[str, str]:
    name = new.name
    found = {
        "setup.py": _setup_py(new),
        "setup.cfg": (
            f"[develop]\nscript_dir=$base/lib/{name}\n[install]\ninstall_scripts=$base/lib/{name}\n"
        ),
        f"resource/{name}": "",
        f"{name}/__init__.py": "",
    }
    if new.node_name:
        found[f"{name}/{new.node_name}.py"] = _PYTHON_NODE.replace("@PACKAGE@", name)
    if new.library_name:
        found[f"{name}/{new.library_name}/__init__.py"] = ""
    found |= {
        "test/test_copyright.py": _linter_test(
            "copyright", "Every source file says who holds the rights.", skipped=True
        ),
        "test/test_flake8.py": _FLAKE8_TEST,
        "test/test_pep257.py": _linter_test("pep257", "The docstrings are as PEP 257 wants them."),
    }
    return found


def _setup_py(new: NewPackage) -> str:
    scripts = ""
    if new.node_name:
        entry = f"{new.node_name} = {new.name}.{new.node_name}:main"
        scripts = f"            {entry!r},\n"
    return f"""\
from setuptools import find_packages, setup

package_name = {new.name!r}

setup(
    name=package_name,
    version={new.version!r},
    packages=find_packages(exclude=['test']),
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/' + package_name]),
        ('share/' + package_name, ['package.xml']),
    ],
    install_requires=['setuptools'],
    zip_safe=True,
    maintainer={new.maintainer_name!r},
    maintainer_email={new.maintainer_email!r},
    description={new.description!r},
    license={(known_license(new.license) or new.license)!r},
    extras_require={{'test': ['pytest']}},
    entry_points={{
        'console_scripts': [
{scripts}        ],
    }},
)
"""


_PYTHON_NODE: Final = """\
def main():
    print('Hi from @PACKAGE@.')


if __name__ == '__main__':
    main()
"""


def _linter_test(linter: str, says: str, *, skipped: bool = False) -> str:
    skip = "@pytest.mark.skip(reason='No source file has a copyright header yet.')\n"
    return f"""\
from ament_{linter}.main import main
import pytest


{skip if skipped else ""}@pytest.mark.{linter}
@pytest.mark.linter
def test_{linter}():
    \"\"\"{says}\"\"\"
    assert main(argv=['.', 'test']) == 0
"""


_FLAKE8_TEST: Final = '''\
from ament_flake8.main import main_with_errors
import pytest


@pytest.mark.flake8
@pytest.mark.linter
def test_flake8():
    """The code keeps to the style of ROS 2."""
    code, errors = main_with_errors(argv=[])
    assert code == 0, '\\n'.join(errors)
'''


def _cmake_files(new: NewPackage) -> dict[str, str]:
    name = new.name
    found = {"CMakeLists.txt": _cmake_lists(new)}
    if new.library_name:
        values = {"PACKAGE": name, "LIBRARY": new.library_name, "GUARD": _guard(new)}
        values |= {"MACRO": name.upper(), "CLASS": _class_name(new.library_name)}
        found[f"include/{name}/visibility_control.h"] = _filled(_VISIBILITY, values)
        found[f"include/{name}/{new.library_name}.hpp"] = _filled(_LIBRARY_HEADER, values)
        found[f"src/{new.library_name}.cpp"] = _filled(_LIBRARY_SOURCE, values)
    if new.node_name:
        found[f"src/{new.node_name}.cpp"] = _filled(_CPP_NODE, {"PACKAGE": name})
    return found


def _guard(new: NewPackage) -> str:
    return f"{new.name.upper()}__{new.library_name.upper()}_HPP_"


def _class_name(name: str) -> str:
    return "".join(part[:1].upper() + part[1:] for part in name.split("_"))


def _filled(template: str, values: dict[str, str]) -> str:
    for name, value in values.items():
        template = template.replace(f"@{name}@", value)
    return template


def _cmake_lists(new: NewPackage) -> str:
    is_ament = new.build_type == "ament_cmake"
    parts = [
        f"cmake_minimum_required(VERSION 3.8)\nproject({new.name})\n",
        'if(CMAKE_COMPILER_IS_GNUCXX OR CMAKE_CXX_COMPILER_ID MATCHES "Clang")\n'
        "  add_compile_options(-Wall -Wextra -Wpedantic)\nendif()\n",
    ]
    packages = ["ament_cmake"] if is_ament else []
    packages += ["rosidl_default_generators"] if new.has_interfaces else []
    found = "".join(f"find_package({one} REQUIRED)\n" for one in (*packages, *new.dependencies))
    if found:
        parts.append(found)
    if new.library_name:
        parts.append(_library_rules(new, is_ament=is_ament))
    if new.node_name:
        parts.append(_node_rules(new))
    if is_ament:
        parts.append(_AMENT_TESTS)
        if new.library_name:
            parts.append(
                "ament_export_targets(export_${PROJECT_NAME} HAS_LIBRARY_TARGET)\n"
                + "".join(f"ament_export_dependencies({one})\n" for one in new.dependencies)
            )
        parts.append("ament_package()\n")
    return "\n".join(parts)


def _links(target: str, new: NewPackage, how: str) -> str:
    if not new.dependencies:
        return ""
    targets = "".join(f"  ${{{one}_TARGETS}}\n" for one in new.dependencies)
    return f"target_link_libraries({target} {how}\n{targets})\n"


def _library_rules(new: NewPackage, *, is_ament: bool) -> str:
    library = new.library_name
    exported = "  EXPORT export_${PROJECT_NAME}\n" if is_ament else ""
    return (
        f"add_library({library} src/{library}.cpp)\n"
        f"target_compile_features({library} PUBLIC cxx_std_17)\n"
        f"target_include_directories({library} PUBLIC\n"
        "  $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include>\n"
        "  $<INSTALL_INTERFACE:include/${PROJECT_NAME}>)\n"
        f"{_links(library, new, 'PUBLIC')}"
        f'target_compile_definitions({library} PRIVATE "{new.name.upper()}_BUILDING_LIBRARY")\n\n'
        "install(\n  DIRECTORY include/\n  DESTINATION include/${PROJECT_NAME}\n)\n"
        f"install(\n  TARGETS {library}\n{exported}"
        "  ARCHIVE DESTINATION lib\n  LIBRARY DESTINATION lib\n  RUNTIME DESTINATION bin\n)\n"
    )


def _node_rules(new: NewPackage) -> str:
    node = new.node_name
    library = f"target_link_libraries({node} PUBLIC {new.library_name})\n"
    return (
        f"add_executable({node} src/{node}.cpp)\n"
        f"target_compile_features({node} PUBLIC cxx_std_17)\n"
        f"target_include_directories({node} PUBLIC\n"
        "  $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include>\n"
        "  $<INSTALL_INTERFACE:include/${PROJECT_NAME}>)\n"
        f"{_links(node, new, 'PUBLIC')}"
        f"{library if new.library_name else ''}\n"
        f"install(\n  TARGETS {node}\n  DESTINATION lib/${{PROJECT_NAME}}\n)\n"
    )


_AMENT_TESTS: Final = """\
if(BUILD_TESTING)
  find_package(ament_lint_auto REQUIRED)
  # No source file has a copyright header, and the folder may be no git repository: both are
  # looked at once these two lines are gone.
  set(ament_cmake_copyright_FOUND TRUE)
  set(ament_cmake_cpplint_FOUND TRUE)
  ament_lint_auto_find_test_dependencies()
endif()
"""
_CPP_NODE: Final = """\
#include <cstdio>

int main()
{
  std::printf("hello world @PACKAGE@ package\\n");
  return 0;
}
"""
_LIBRARY_HEADER: Final = """\
#ifndef @GUARD@
#define @GUARD@

#include "@PACKAGE@/visibility_control.h"

namespace @PACKAGE@
{

class @CLASS@
{
public:
  @MACRO@_PUBLIC @CLASS@();
  @MACRO@_PUBLIC virtual ~@CLASS@();
};

}  // namespace @PACKAGE@

#endif  // @GUARD@
"""
_LIBRARY_SOURCE: Final = """\
#include "@PACKAGE@/@LIBRARY@.hpp"

namespace @PACKAGE@
{

@CLASS@::@CLASS@() = default;

@CLASS@::~@CLASS@() = default;

}  // namespace @PACKAGE@
"""
_VISIBILITY: Final = """\
#ifndef @MACRO@__VISIBILITY_CONTROL_H_
#define @MACRO@__VISIBILITY_CONTROL_H_

// @MACRO@_PUBLIC marks what users of the shared library see, @MACRO@_LOCAL what they do not.
#if defined(_WIN32)
  #define @MACRO@_LOCAL
  #if defined(@MACRO@_BUILDING_LIBRARY)
    #define @MACRO@_PUBLIC __declspec(dllexport)
  #else
    #define @MACRO@_PUBLIC __declspec(dllimport)
  #endif
#else
  #define @MACRO@_PUBLIC __attribute__((visibility("default")))
  #define @MACRO@_LOCAL __attribute__((visibility("hidden")))
#endif

#endif  // @MACRO@__VISIBILITY_CONTROL_H_
"""
