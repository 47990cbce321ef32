/** How the things that a text can name are shown. */

/** @import { SubjectKind } from "../types/wire.d.ts" */

/** @type {Record<SubjectKind, string>} names of icons */
const ICONS = {
  property: "properties",
  arg: "sliders",
  parameter: "sliders",
  block: "copy",
  macro: "macro",
  namespace: "includes",
  package: "package",
  file: "file",
  folder: "folder",
  yaml: "fileCode",
  function: "source",
  constant: "dots",
  variable: "dots",
  environment: "system",
  command: "source",
  link: "box",
  joint: "joints",
  expression: "source",
  tag: "source",
  element: "source",
  attribute: "source",
  value: "dots",
};

/** @param {SubjectKind} kind @returns {string} the name of its icon */
export const kindIcon = (kind) => ICONS[kind];
