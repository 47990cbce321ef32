from __future__ import annotations

import pytest

from studio.server.modules import Modules, bare
from studio.settings import repository_or_wheel


def joined(texts: dict[str, str]) -> Modules:
    return Modules({path: text.encode() for path, text in texts.items()})


PAGE = {
    "app/main.js": (
        'import { html as write } from "vendor/preact.js";\n'
        'import { one, Two } from "../lib/one.js";\n'
        'await (await import("../panels/log/log.js")).show(write, one, Two);\n'
    ),
    "lib/one.js": (
        'import { deep } from "./deep.js";\n'
        "export const one = deep(import.meta.url);\n"
        "export class Two {}\n"
    ),
    "lib/deep.js": (
        "/** Answers\n * it. */\nexport function deep(it) {\n  return it; // as it is\n}\n"
    ),
    "panels/log/log.js": (
        'import { one } from "../../lib/one.js";\n'
        'import { row } from "./row.js";\n'
        'import { long } from "../../lib/long.js";\n'
        "export async function show() {\n  return row(one, long);\n}\n"
    ),
    "panels/log/row.js": (
        "export const row = (...all) => all;\n"
        'const later = () => import("../plot.js");\n'
        'const address = new URL("a.png", import.meta.url);\n'
    ),
    "panels/plot.js": 'import { long } from "../lib/long.js";\nexport const plot = long;\n',
    "lib/long.js": "export const long = 1;\n",
    "workers/data.js": 'import { one } from "../lib/one.js";\nself.one = one;\n',
}


def test_what_the_page_begins_with_is_one_file():
    assert joined(PAGE).text("app/main.js") == (
        'import * as $vendor_preact from "vendor/preact.js";\n'
        "const $lib_deep = (() => {\n"
        "function deep(it) {\nreturn it; \n}\n"
        "return { deep };\n})();\n"
        "const $lib_one = (() => {\n"
        "const { deep } = $lib_deep;\n"
        'const one = deep(new URL("../lib/one.js", import.meta.url).href);\n'
        "class Two {}\n"
        "return { one, Two };\n})();\n"
        "const $app_main = await (async () => {\n"
        "const { html: write } = $vendor_preact;\n"
        "const { one, Two } = $lib_one;\n"
        'await (await import("../panels/log/log.js")).show(write, one, Two);\n'
        "return {  };\n})();\n"
        "export { $lib_deep, $lib_one, $app_main };\n"
    )


def test_what_is_imported_later_takes_from_the_files_that_are_there():
    assert joined(PAGE).text("panels/log/log.js") == (
        'import { $lib_one } from "../../app/main.js";\n'
        'import * as $lib_long from "../../lib/long.js";\n'
        "const $panels_log_row = (() => {\n"
        "const row = (...all) => all;\n"
        'const later = () => import("../plot.js");\n'
        'const address = new URL("a.png", new URL("./row.js", import.meta.url).href);\n'
        "return { row };\n})();\n"
        "const $panels_log_log = (() => {\n"
        "const { one } = $lib_one;\n"
        "const { row } = $panels_log_row;\n"
        "const { long } = $lib_long;\n"
        "async function show() {\nreturn row(one, long);\n}\n"
        "return { show };\n})();\n"
        "export { $panels_log_row, $panels_log_log };\n"
        "export const { show } = $panels_log_log;\n"
    )


def test_what_two_doors_lead_to_is_a_file_of_its_own():
    assert joined(PAGE).text("lib/long.js") == "export const long = 1;\n"


def test_a_module_of_another_file_is_the_same_one_under_its_own_address():
    assert joined(PAGE).text("lib/one.js") == (
        'import { $lib_one } from "../app/main.js";\nexport const { one, Two } = $lib_one;\n'
    )


def test_what_is_named_only_when_it_is_imported_later_is_a_door_too():
    texts = PAGE | {
        "app/main.js": 'import "./panels.js";\n',
        "app/panels.js": "export const load = (id) => import(`../panels/${id}/${id}.js`);\n",
    }
    modules = joined(texts)
    text = modules.text("panels/log/log.js")
    assert text is not None
    assert "const $panels_log_row = (() => {" in text
    assert modules.imported(["app/main.js"]) == []


def test_a_worker_has_copies():
    text = joined(PAGE).text("workers/data.js")
    assert text is not None
    assert "import {" not in text
    assert "const $lib_one = (() => {" in text


def test_a_page_names_the_files_that_come_with_its_own():
    assert joined(PAGE).imported(["app/main.js"]) == ["vendor/preact.js"]
    assert joined(PAGE).imported(["panels/log/log.js"]) == [
        "app/main.js",
        "lib/long.js",
        "vendor/preact.js",
    ]


@pytest.mark.parametrize(
    "other",
    [
        'export * from "./deep.js";\n',
        "export default 1;\n",
        'import * as all from "./deep.js";\n',
        'import { one } from "./one.js";\nexport const deeper = one;\n',
    ],
)
def test_what_is_written_otherwise_is_served_as_written_with_what_it_imports(other: str):
    texts = {
        "app/main.js": 'import { one } from "./one.js";\nimport { two } from "./two.js";\n',
        "app/one.js": 'import { other } from "./other.js";\nexport const one = other;\n',
        "app/two.js": "export const two = 2;\n",
        "app/other.js": other,
        "app/deep.js": "export const deep = 1;\n",
    }
    modules = joined(texts)
    assert modules.text("app/other.js") is None
    text = modules.text("app/main.js")
    assert text is not None
    assert "const $app_two = (() => {" in text
    assert (modules.text("app/deep.js") is None) == ("deep.js" in other)


def test_a_key_may_be_called_as_a_word_of_modules():
    assert joined({"a.js": "const a = {\nexport: 1,\n};\n"}).text("a.js")


@pytest.mark.parametrize(
    ("written", "left"),
    [
        ("// all\nlet a = 1; // one\n\n  let b = 2;\n", "let a = 1; \nlet b = 2;\n"),
        ("/** @type {X} */\nlet a = /** @type {Y} */ (b);\n", "let a =  (b);\n"),
        (
            "let a = \"// no /* no\";\nlet b = '\\'//';\n",
            "let a = \"// no /* no\";\nlet b = '\\'//';\n",
        ),
        (
            "let a = `// no\n  ${f({ /* yes */ a: `\n  b` })}\n  c`;\n",
            "let a = `// no\n  ${f({  a: `\n  b` })}\n  c`;\n",
        ),
        ('let a = b.replace(/[/*]`"/g, c) / d; // e\n', 'let a = b.replace(/[/*]`"/g, c) / d; \n'),
        ("let a = b / c; let d = `${e / f}`; // g / h\n", "let a = b / c; let d = `${e / f}`; \n"),
        ("if (a) {\n  b();\n}\n/* end", "if (a) {\nb();\n}\n/* end"),
    ],
)
def test_comments_and_indentation_are_left_out_but_not_of_texts(written: str, left: str):
    assert bare(written) == left


def test_the_page_itself_begins_with_few_files():
    folder = repository_or_wheel("frontend_assets")
    parts = [path for path in folder.rglob("*.js") if "node_modules" not in path.parts]
    own = {path.relative_to(folder).as_posix(): path.read_bytes() for path in parts}
    modules = Modules({path: text for path, text in own.items() if path[:7] != "vendor/"})
    libraries = {"vendor/preact.js", "vendor/dockview.js", "vendor/icons.js"}
    assert set(modules.imported(["app/main.js"])) == libraries
    assert modules.imported(["viser/studio3d.js"]) == []
