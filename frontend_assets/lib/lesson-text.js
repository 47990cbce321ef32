/** Reading a lesson's file: its head, and the text below in the markup of the help. */

import { readHelp } from "./help-text.js";

/** @typedef {{title: string, needs: readonly string[], blocks: readonly import("./help-text.js").Block[]}} Lesson */

const HEAD = /^# (.+)\n(?:needs:(.*)\n)?/;

/** @param {string} text @returns {Lesson} */
export function readLesson(text) {
  const [head = "", title = "", needs = ""] = HEAD.exec(text) ?? [];
  return {
    title: title.trim(),
    needs: needs.split(" ").filter(Boolean),
    blocks: readHelp(text.slice(head.length)),
  };
}

/**
 * @param {string} words what is sought
 * @param {{demo: string, node: string}} named
 * @param {string} text of its lesson
 * @returns {boolean} each of the words is somewhere in it
 */
export function isSought(words, { demo, node }, text) {
  const all = `${demo} ${node} ${text}`.toLowerCase();
  return words
    .toLowerCase()
    .split(/\s+/)
    .every((word) => all.includes(word));
}
