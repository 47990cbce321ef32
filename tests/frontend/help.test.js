import assert from "node:assert/strict";
import { existsSync, readdirSync, readFileSync, statSync } from "node:fs";
import { test } from "node:test";
import { OF_DIALOG, OTHER_PAGES } from "../../frontend_assets/app/help.js";
import { searchHelp } from "../../frontend_assets/app/help-sheet.js";
import { partsOf, plainHelp, readHelp } from "../../frontend_assets/lib/help-text.js";
import { ICON_NAMES, PANEL_IDS as PANELS } from "./support/panels.js";
import { wordsOf } from "./support/words.js";

const ASSETS = new URL("../../frontend_assets/", import.meta.url);
const LANGUAGES = ["en", "de"];
const PICTURES_LARGEST = 1_500_000;

/** @param {string} path */
const textOf = (path) => readFileSync(new URL(path, ASSETS), "utf8");

const PAGES = [...PANELS, ...Object.values(OTHER_PAGES).flat()];
/** These explain words; every other page shows what it is about. */
const WITHOUT_PICTURE = OTHER_PAGES.words;

test("the panels are found", () => {
  assert.ok(PANELS.includes("scene") && PANELS.includes("urdf") && PANELS.length >= 12);
});

/** @param {string} page @param {string} language @returns {string} its path */
const pathOf = (page, language) =>
  PANELS.includes(page) ? `panels/${page}/help.${language}.md` : `help/${language}/${page}.md`;

/** @param {string} page @param {string} theme @returns {string} path of its picture */
const pictureOf = (page, theme) =>
  PANELS.includes(page)
    ? `panels/${page}/help-${theme}.webp`
    : `help/pictures/${page}-${theme}.webp`;

/** @param {RegExp} name @returns {string[]} paths of all files so named, in the help and in folders of panels */
const filesNamed = (name) =>
  ["help/", "panels/"]
    .flatMap((folder) =>
      readdirSync(new URL(folder, ASSETS), { recursive: true }).map((one) => `${folder}${one}`),
    )
    .filter((path) => name.test(path))
    .sort();

const MARKS = textOf("styles/help.css");

/** @param {import("../../frontend_assets/lib/help-text.js").Part} part @returns {boolean} it leads somewhere, or is drawn */
function isKnown(part) {
  switch (part.kind) {
    case "link":
      return PAGES.includes(part.page);
    case "icon":
      return ICON_NAMES.includes(part.text);
    case "mark":
      return MARKS.includes(`.help-mark.${part.text}`);
    case "text":
      // What the reader did not understand would be shown as it was written.
      return !/\*\*|\]\(|\{|`|^#|!\[/.test(part.text);
    default:
      return part.text !== "";
  }
}

for (const language of LANGUAGES) {
  const readPage = (/** @type {string} */ page) => readHelp(textOf(pathOf(page, language)));

  test(`every panel and every task has a page in ${language}, and no page is left over`, () => {
    const files = filesNamed(new RegExp(`^help/${language}/.*\\.md$|\\.${language}\\.md$`));
    assert.deepEqual(files, PAGES.map((page) => pathOf(page, language)).sort());
  });

  test(`links, icons, keys and marks of the pages in ${language} are known`, () => {
    for (const page of PAGES)
      for (const part of readPage(page).flatMap(partsOf))
        assert.ok(isKnown(part), `${language}/${page}: ${part.text}`);
  });

  test(`every page in ${language} has its picture in both themes and says what it shows`, () => {
    for (const page of PAGES) {
      const pictures = readPage(page).filter(({ kind }) => kind === "picture");
      assert.equal(pictures.length, WITHOUT_PICTURE.includes(page) ? 0 : 1, page);
      for (const one of pictures) {
        assert.ok(one.kind === "picture" && one.alt.length > 10, page);
        for (const theme of ["dark", "light"])
          assert.ok(existsSync(new URL(pictureOf(one.name, theme), ASSETS)), page);
      }
    }
  });

  test(`every page in ${language} says what to do, and is short`, () => {
    for (const page of PAGES) {
      const blocks = readPage(page);
      assert.ok(blocks.filter(({ kind }) => kind === "heading").length >= 1, page);
      const words = plainHelp(blocks).split(/\s+/).length;
      assert.ok(words > 60 && words < 330, `${language}/${page}: ${words} words`);
    }
  });
}

test("every page has its title in the catalogue", () => {
  for (const language of LANGUAGES) {
    const words = wordsOf(language);
    for (const page of PAGES)
      assert.ok(words[PANELS.includes(page) ? `panel.${page}` : `help.page.${page}`], page);
    for (const group of ["panels", ...Object.keys(OTHER_PAGES)])
      assert.ok(words[`help.group.${group}`], group);
  }
});

test("every window but a question and the search, which finds it, has help, on a page that exists", () => {
  const shown = [...textOf("app/dialogs.js").matchAll(/case "(\w+)":/g)].map(([, kind]) => kind);
  assert.ok(shown.length > 5);
  for (const kind of shown)
    if (kind !== "confirm" && kind !== "palette")
      assert.ok(PAGES.includes(OF_DIALOG[kind ?? ""] ?? ""), kind);
});

test("the pictures are small enough to travel with the studio", () => {
  const files = filesNamed(/\.webp$/);
  const used = PAGES.flatMap((page) => [pictureOf(page, "dark"), pictureOf(page, "light")]);
  for (const file of files) assert.ok(used.includes(file), file);
  const bytes = files.reduce((sum, file) => sum + statSync(new URL(file, ASSETS)).size, 0);
  assert.ok(bytes < PICTURES_LARGEST, String(bytes));
});

test("a text becomes headings, lists and parts of a line", () => {
  const text =
    "![A panel](joints)\n\nPress **Zero**, `a*b` or\n{key Mod+K}.\n\n## Do\n\n- one [page](joints)\n  more\n- {icon eye} two";
  assert.deepEqual(readHelp(text), [
    { kind: "picture", name: "joints", alt: "A panel" },
    {
      kind: "text",
      parts: [
        { kind: "text", text: "Press " },
        { kind: "strong", text: "Zero" },
        { kind: "text", text: ", " },
        { kind: "code", text: "a*b" },
        { kind: "text", text: " or " },
        { kind: "key", text: "Mod+K" },
        { kind: "text", text: "." },
      ],
    },
    { kind: "heading", parts: [{ kind: "text", text: "Do" }] },
    {
      kind: "list",
      entries: [
        [
          { kind: "text", text: "one " },
          { kind: "link", text: "page", page: "joints", about: [] },
          { kind: "text", text: " more" },
        ],
        [
          { kind: "icon", text: "eye" },
          { kind: "text", text: " two" },
        ],
      ],
    },
  ]);
});

test("markup in a text stays text", () => {
  const [block] = readHelp("<img src=x onerror=alert(1)> [x](https://example.org)");
  assert.deepEqual(block, {
    kind: "text",
    parts: [{ kind: "text", text: "<img src=x onerror=alert(1)> [x](https://example.org)" }],
  });
});

test("a search wants every word, and pages named so come first", () => {
  const texts = [
    { page: "a", title: "Joints", text: "They move links. A mass is heavy." },
    { page: "b", title: "Masses", text: "What a link weighs." },
    { page: "c", title: "Source", text: "mass mass mass" },
  ];
  const pages = (/** @type {string} */ words) => searchHelp(texts, words).map(({ page }) => page);
  assert.deepEqual(pages("mass"), ["b", "c", "a"]);
  assert.deepEqual(pages("LINK mass"), ["b", "a"]);
  assert.deepEqual(pages("wings"), []);
  assert.deepEqual(pages("  "), []);
});

test("what was found is shown in whole words around it", () => {
  const far = `${"before ".repeat(30)}needle${" behind".repeat(40)}`;
  const [found] = searchHelp([{ page: "a", title: "A", text: far }], "needle");
  assert.match(found?.excerpt ?? "", /^… (before )+needle( behind)+ …$/);
});
