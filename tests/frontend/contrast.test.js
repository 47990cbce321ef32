import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { test } from "node:test";

const STYLES = new URL("../../frontend_assets/styles/", import.meta.url);
const AA_TEXT = 4.5;
/** Of what is no text but has to be seen: the ring around what has the focus, a chosen icon. */
const AA_SIGN = 3;

const WORDS = ["text", "muted", "accent-text", "amber", "red", "green", "violet", "source-name"];
const GROUNDS = ["page", "bar-bg", "panel", "raised", "field", "hover"];
/** What else stands on what. @type {readonly (readonly [string, string])[]} */
const PAIRS = [
  ["text", "pressed"],
  ["accent-text", "accent-soft"],
  ["text", "accent-soft"],
  ["muted", "accent-soft"],
  ["on-accent", "accent"],
  ["text", "red-soft"],
  ["red", "red-soft"],
];

/** @param {string} theme @returns {Map<string, string>} its colours of six digits, by name */
function coloursOf(theme) {
  const css = readFileSync(new URL("tokens.css", STYLES), "utf8");
  const block = new RegExp(`data-theme="${theme}"\\] \\{([^}]*)\\}`).exec(css)?.[1] ?? "";
  const found = [...block.matchAll(/--([\w-]+): (#[0-9a-f]{6});/g)];
  return new Map(found.map(([, name = "", colour = ""]) => [name, colour]));
}

/** @param {string} colour `#rrggbb` @returns {number} relative luminance as WCAG has it, 0 to 1 */
function luminance(colour) {
  const [red = 0, green = 0, blue = 0] = [1, 3, 5].map((at) => {
    const share = Number.parseInt(colour.slice(at, at + 2), 16) / 255;
    return share <= 0.04045 ? share / 12.92 : ((share + 0.055) / 1.055) ** 2.4;
  });
  return 0.2126 * red + 0.7152 * green + 0.0722 * blue;
}

/** @param {string} one @param {string} other @returns {number} 1 to 21 */
function contrast(one, other) {
  const [dark = 0, bright = 0] = [luminance(one), luminance(other)].sort((a, b) => a - b);
  return (bright + 0.05) / (dark + 0.05);
}

for (const theme of ["dark", "light"]) {
  const colours = coloursOf(theme);
  const of = (/** @type {string} */ name) => {
    const colour = colours.get(name);
    assert.ok(colour, `${theme} has no plain colour --${name}`);
    return colour;
  };

  test(`every text of the ${theme} theme can be read on every ground`, () => {
    const all = [...WORDS.flatMap((word) => GROUNDS.map((ground) => [word, ground])), ...PAIRS];
    const poor = all
      .map(([word = "", ground = ""]) => ({ word, ground, is: contrast(of(word), of(ground)) }))
      .filter(({ is }) => is < AA_TEXT)
      .map(({ word, ground, is }) => `--${word} on --${ground}: ${is.toFixed(2)}`);
    assert.deepEqual(poor, []);
  });

  test(`the ring around what has the focus is seen in the ${theme} theme`, () => {
    for (const ground of [...GROUNDS, "accent-soft"])
      assert.ok(contrast(of("accent"), of(ground)) >= AA_SIGN, ground);
  });
}

test("no style sheet but that of the tokens names a colour of its own for words", () => {
  const files = ["./", "../panels/"].flatMap((folder) =>
    readdirSync(new URL(folder, STYLES), { recursive: true }).map((name) => `${folder}${name}`),
  );
  for (const file of files.filter((name) => name.endsWith(".css"))) {
    if (file === "./tokens.css") continue;
    const css = readFileSync(new URL(file, STYLES), "utf8");
    const own = [
      ...css.matchAll(/(?:^|[\s;{])color:\s*(#(?!ffffff)[0-9a-f]{3,8}|rgb[^;]*|[a-z]+);/g),
    ]
      .map(([, colour]) => colour ?? "")
      .filter((colour) => !["inherit", "currentcolor", "transparent"].includes(colour));
    assert.deepEqual(own, [], file);
  }
});
