import assert from "node:assert/strict";
import { test } from "node:test";
import { snippetTemplate } from "../../frontend_assets/panels/source/completion.js";
import { EditorState, snippet } from "../../frontend_assets/vendor/codemirror.js";

/** @param {string} template @returns {{text: string, selection: string}} what CodeMirror writes */
function written(template) {
  let state = EditorState.create({});
  const editor = {
    state,
    dispatch: (/** @type {any} */ transaction) => {
      state = transaction.state;
    },
  };
  snippet(template)(editor, null, 0, 0);
  const { from, to } = state.selection.main;
  return { text: state.doc.toString(), selection: state.sliceDoc(from, to) };
}

test("a text is written as it is, whatever signs it holds", () => {
  for (const text of ["<a b='1'/>", "${x} $(find y) #{z} {}", "\\{ \\", "#{1}"]) {
    assert.equal(written(snippetTemplate(text, [])).text, text);
  }
});

test("the cursor goes to the first stop, its text selected", () => {
  const text = '<a b="${x}" c="name"/>';
  const at = text.indexOf("name");
  const template = snippetTemplate(text, [
    [at, at + 4],
    [text.length, text.length],
  ]);
  assert.deepEqual(written(template), { text, selection: "name" });
});

test("empty stops leave no sign", () => {
  assert.equal(
    written(
      snippetTemplate('<a b="" c=""/>', [
        [6, 6],
        [11, 11],
      ]),
    ).text,
    '<a b="" c=""/>',
  );
});
