/** How source texts look in the editor: colours by class, styled in source.css. */

import {
  Decoration,
  MatchDecorator,
  syntaxHighlighting,
  tagHighlighter,
  tags,
  ViewPlugin,
} from "vendor/codemirror.js";

const CLASSES = syntaxHighlighting(
  tagHighlighter([
    { tag: tags.tagName, class: "source-tag" },
    { tag: tags.angleBracket, class: "source-bracket" },
    { tag: tags.attributeName, class: "source-name" },
    { tag: [tags.attributeValue, tags.string, tags.content], class: "source-value" },
    { tag: [tags.number, tags.bool, tags.atom], class: "source-value" },
    { tag: tags.propertyName, class: "source-name" },
    { tag: [tags.comment, tags.processingInstruction, tags.documentMeta], class: "source-comment" },
    { tag: [tags.character, tags.meta, tags.keyword, tags.labelName], class: "source-special" },
    { tag: tags.invalid, class: "source-invalid" },
  ]),
);

const XACRO = new MatchDecorator({
  regexp: /(\$\$?\{[^{}\n]*\}|\$\$?\([^()\n]*(?:\([^()\n]*\)[^()\n]*)*\))|(<\/?xacro:[\w.:-]*)/g,
  decoration: ([, expression]) => (expression ? EXPRESSION : XACRO_TAG),
});
const EXPRESSION = Decoration.mark({ class: "source-expression" });
const XACRO_TAG = Decoration.mark({ class: "source-xacro" });

const XACRO_MARKS = ViewPlugin.define(
  (view) => {
    let marks = XACRO.createDeco(view);
    return {
      /** @param {import("vendor/codemirror.js").ViewUpdate} update */
      update(update) {
        marks = XACRO.updateDeco(update, marks);
      },
      get marks() {
        return marks;
      },
    };
  },
  { decorations: ({ marks }) => marks },
);

export const SOURCE_LOOK = [CLASSES, XACRO_MARKS];
