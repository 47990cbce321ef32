/** What the palette offers of ROS 2: lessons, their demos, and command lines of `ros2`. */

/** @import { BagLine } from "../lib/bag-lines.js" */
/** @import { Ros2Line } from "../lib/ros2-lines.js" */
/** @import { LessonView } from "../types/wire.d.ts" */
/** @import { Choice } from "./palette-choices.js" */

import { readBagLine } from "../lib/bag-lines.js";
import { commandById, commandLabel } from "../lib/commands.js";
import { commandsOf, mendedLine, toldLines } from "../lib/course-lines.js";
import { language, t } from "../lib/i18n.js";
import { readLine, ros2LinesFor } from "../lib/ros2-lines.js";
import { mayManage } from "../model/connection.js";
import {
  askLessons,
  chosenLesson,
  fetchLessons,
  isUnderWay,
  lessons,
  lessonTexts,
  startDemos,
  stopDemo,
} from "../model/lessons.js";
import { goalForm, publishForm, serviceForm } from "../model/message-forms.js";
import { actions, askActions, askServices, services } from "../model/operations.js";
import { chooseNode } from "../model/parameters.js";
import { askWorkspaces } from "../model/programs.js";
import { openBagNamed, prepareRecording } from "../model/recording.js";
import { ros } from "../model/ros.js";
import { chosenTopic } from "../model/topics.js";
import { notify } from "../model/view.js";
import { programChoices } from "./palette-programs.js";
import { panelTitle } from "./panels.js";

/** Services that courses call by name before anybody asked the graph for them. @type {Record<string, string>} */
const WELL_KNOWN = {
  "/spawn": "turtlesim/srv/Spawn",
  "/kill": "turtlesim/srv/Kill",
  "/clear": "std_srvs/srv/Empty",
  "/reset": "std_srvs/srv/Empty",
  "/turtle1/cmd_vel": "geometry_msgs/msg/Twist",
};

/** Have the list of lessons, what runs of them, and their texts. */
export async function askForLessons() {
  // A call that lacks its type is mended with what the graph knows.
  if (ros.peek().state === "connected") void Promise.all([askServices(), askActions()]);
  void askWorkspaces();
  await askLessons();
  await fetchLessons(language.peek(), lessons.peek() ?? []);
}

/** @param {string} name */
function showLesson(name) {
  chosenLesson.value = name;
  commandById("panel.lessons")?.run();
}

/** @param {LessonView} lesson @returns {string} */
const titleOf = ({ name }) => lessonTexts.value.get(name)?.title || name;

/** @returns {Choice[]} each is also found by its demo, its node and what its first sentences say */
export function lessonChoices() {
  return (lessons.value ?? []).map((lesson) => ({
    rank: "lesson",
    key: `lesson ${lesson.name}`,
    icon: "lessons",
    label: t("palette.lesson", { name: titleOf(lesson) }),
    words: `${lesson.name} ${lesson.node} ${firstParagraph(lesson.name)}`,
    hint: lesson.name,
    does: t("palette.does.lesson"),
    run: () => showLesson(lesson.name),
  }));
}

/** @param {string} name @returns {string} */
function firstParagraph(name) {
  const block = lessonTexts.value.get(name)?.blocks[0];
  return block?.kind === "text" ? block.parts.map(({ text }) => text).join("") : "";
}

/** @returns {Choice[]} demos to be started, and those that run to be stopped */
export function demoChoices() {
  if (!mayManage.value || ros.value.state !== "connected") return [];
  const withDemo = (lessons.value ?? []).filter(({ node }) => node !== "");
  return withDemo.map((lesson) => {
    const { name: demo, node } = lesson;
    const runs = isUnderWay(demo);
    return {
      rank: "demo",
      key: `demo ${demo}`,
      icon: runs ? "stop" : "animate",
      label: t(runs ? "palette.demo.stop" : "palette.demo.start", { name: demo }),
      words: `${node} ${titleOf(lesson)} demo`,
      hint: node,
      does: t(runs ? "palette.does.demo.stop" : "palette.does.demo.start"),
      run: () => {
        showLesson(demo);
        void (runs ? stopDemo(demo) : startDemos([demo]));
      },
    };
  });
}

/**
 * What a typed or pasted line of a shell is here: done in a panel, explained, or mended first.
 *
 * @param {string} text that was typed
 * @returns {Choice[]} none where it is no line that courses of ROS 2 print
 */
export function ros2Choices(text) {
  const real = programChoices(text);
  if (real.length > 0) return real;
  const commands = commandsOf(text);
  const whole = commands.length > 1 ? commands : [text];
  return [
    ...mendedChoices(text),
    ...toldChoices(text),
    ...whole.flatMap((command) => lineChoices(command)),
  ];
}

/** @param {string} text of one command @returns {Choice[]} */
function lineChoices(text) {
  if (toldLines(text).length > 0) return [];
  return ros2LinesFor(text).map(({ line, rest }) => ({
    rank: "ros2",
    key: line.line,
    icon: "keyboard",
    label: [line.line, ...rest].join(" "),
    hint: placeName(line),
    does: t(line.form && rest.length > 1 ? "palette.does.form" : "palette.does.ros2", {
      panel: placeName(line),
    }),
    run: () => follow(line, rest, text),
  }));
}

/** @param {string} text @returns {Choice[]} the line that was meant by a misspelt one */
function mendedChoices(text) {
  const mended = mendedLine(text, typeInGraph);
  const [meant] = mended ? ros2LinesFor(mended) : [];
  if (!mended || !meant) return [];
  const { line, rest } = meant;
  return [
    {
      rank: "ros2",
      key: `mended ${line.line}`,
      icon: "wand",
      label: mended,
      hint: t("palette.hint.mended"),
      does: t("palette.does.mended", { panel: placeName(line) }),
      run: () => follow(line, rest, mended),
    },
  ];
}

/** @param {string} kind @param {string} name @returns {string} the type of a topic or service that the studio has seen; empty: not known */
export function typeInGraph(kind, name) {
  const known = kind === "service" ? services.value : kind === "action" ? actions.value : null;
  return known?.find((one) => one.name === name)?.types[0] ?? WELL_KNOWN[name] ?? "";
}

/** @param {string} text @returns {Choice[]} */
function toldChoices(text) {
  return toldLines(text).map(({ command, key, values, panel }) => {
    const sentence = t(`line.${key}`, values);
    const place = commandById(`panel.${panel}`);
    return {
      rank: "ros2",
      key: `told ${key}`,
      icon: "help",
      label: command,
      hint: place && panel ? panelTitle(panel) : t("palette.hint.explained"),
      does: sentence,
      run: () => {
        place?.run();
        notify(sentence, { long: true });
      },
    };
  });
}

/** @param {Ros2Line} line @returns {string} where it is done: a panel, or a window */
function placeName({ panel }) {
  if (commandById(`panel.${panel}`)) return panelTitle(panel);
  const command = commandById(panel);
  return command ? commandLabel(command) : panel;
}

const FORMS = { topic: publishForm, service: serviceForm, action: goalForm };

/** @param {Ros2Line} line @param {readonly string[]} rest @param {string} text */
function follow(line, rest, text) {
  if (line.about === "bag") followBagLine(text);
  else followInPanel(line, rest, text);
}

/** @param {Ros2Line} line @param {readonly string[]} rest @param {string} text */
function followInPanel({ panel, about, form }, rest, text) {
  const pasted = form && readLine(text);
  if (pasted) void FORMS[form].open({ name: rooted(pasted.name), type: pasted.type }, pasted.text);
  const [name] = rest.filter((word) => !word.startsWith("-"));
  if (name && about === "topic") chosenTopic.value = rooted(name);
  if (name && about === "node") chooseNode(rooted(name));
  if (about === "demo") {
    const known = lessons.value?.find(({ name: demo }) => rest.includes(demo));
    if (known) chosenLesson.value = known.name;
    else if (rest.length > 1) {
      const program = rest.slice(0, 2).join(" ");
      notify(t("line.run", { program }), { long: true });
      return;
    }
  }
  (commandById(`panel.${panel}`) ?? commandById(panel))?.run();
}

/** @param {string} text a recording is prepared, for whoever presses the button; a bag is opened */
function followBagLine(text) {
  const line = readBagLine(text);
  if (line?.verb === "record") prepareRecording(line.form);
  else void openBagNamed(line?.paths[0] ?? "");
  for (const sentence of line ? unsaidOf(line) : []) notify(sentence, { long: true });
}

/** @param {BagLine} line @returns {string[]} what the page does not do of it */
function unsaidOf(line) {
  const [opened = "", ...others] = line.verb === "record" ? [] : line.paths;
  const sentences = [];
  if (others.length > 0) sentences.push(t("line.bag.one", { opened, others: others.join(", ") }));
  if (line.leftOut.length > 0)
    sentences.push(t("line.bag.left_out", { words: line.leftOut.join(", ") }));
  return sentences;
}

/** @param {string} name @returns {string} */
const rooted = (name) => (name.startsWith("/") ? name : `/${name}`);
