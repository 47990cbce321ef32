/** What vendor/codemirror.js exports: CodeMirror 6 whole, for every package of it must be there once. */
export * from "@codemirror/state";
export * from "@codemirror/view";
export * from "@codemirror/commands";
export * from "@codemirror/language";
export * from "@codemirror/autocomplete";
export * from "@codemirror/search";
export * from "@codemirror/lint";
export * from "@codemirror/lang-python";
export * from "@codemirror/lang-xml";
export * from "@codemirror/lang-yaml";
export * from "@lezer/highlight";
