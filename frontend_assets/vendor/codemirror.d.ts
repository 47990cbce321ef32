/**
 * What vendor/codemirror.js exports: of CodeMirror 6 what the page takes. vendor.mjs makes it of this
 * file: a name to come is added here, and `npm run vendor` run.
 */
export {
  Annotation,
  ChangeSet,
  Compartment,
  EditorState,
  RangeSet,
  RangeSetBuilder,
  StateEffect,
  StateField,
  Text,
} from "@codemirror/state";
export {
  Decoration,
  EditorView,
  GutterMarker,
  MatchDecorator,
  ViewPlugin,
  closeHoverTooltips,
  crosshairCursor,
  drawSelection,
  gutter,
  highlightActiveLine,
  highlightActiveLineGutter,
  highlightSpecialChars,
  hoverTooltip,
  keymap,
  lineNumbers,
  rectangularSelection,
  showTooltip,
} from "@codemirror/view";
export { defaultKeymap, indentWithTab } from "@codemirror/commands";
export {
  StreamLanguage,
  bracketMatching,
  ensureSyntaxTree,
  foldAll,
  foldGutter,
  foldKeymap,
  indentOnInput,
  indentUnit,
  syntaxHighlighting,
  syntaxTree,
  unfoldAll,
} from "@codemirror/language";
export {
  acceptCompletion,
  autocompletion,
  closeBrackets,
  closeBracketsKeymap,
  snippet,
  startCompletion,
} from "@codemirror/autocomplete";
export {
  gotoLine,
  highlightSelectionMatches,
  openSearchPanel,
  search,
  searchKeymap,
} from "@codemirror/search";
export { lintGutter, lintKeymap, setDiagnostics } from "@codemirror/lint";
export { python } from "@codemirror/lang-python";
export { xml } from "@codemirror/lang-xml";
export { yaml } from "@codemirror/lang-yaml";
export { tagHighlighter, tags } from "@lezer/highlight";
export type * from "@codemirror/state";
export type * from "@codemirror/view";
export type * from "@codemirror/autocomplete";
export type * from "@codemirror/lint";
export type * from "@codemirror/language";
