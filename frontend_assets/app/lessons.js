/**
 * The lessons: one page about each demo, in `lessons/<language>/<name of the demo>.md`.
 *
 * A lesson file begins with its title, `# A publisher that counts` (a few words, no full stop), alone
 * on its line. The next line may say which demos it wants beside its own, by their names and in the
 * order in which they are started: `needs: listener` or `needs: jerry_robot jerry_client`; it is the
 * same in every language. An empty line, then the text in the markup of `lib/help-text.js`: blocks
 * between empty lines; `## Heading`, lists of `- entries` (an entry may go on in the next line), all
 * else paragraphs; in them `**name of a control**`, code in backticks, `{key Mod+K}`, `{icon eye}`.
 * No pictures, no HTML, no numbered lists.
 *
 * Links open panels, by the id that stands in `app/panels.js`, and may say what is shown there:
 *   `[words](topics)`  `[words](graph)`  any panel
 *   `[words](topics /chatter)`  that topic, opened
 *   `[words](parameters /turtlesim)`  that node's parameters
 *   `[words](services /spawn turtlesim/srv/Spawn)`  the form of that service; its type is needed
 *   `[words](actions /fibonacci example_interfaces/action/Fibonacci)`, `[words](publish /cmd_vel
 *   geometry_msgs/msg/Twist)`  likewise
 *   `[words](lessons listener)`  another lesson
 *   `[words](open r2d2_description stands:=false)`  a robot that comes with the studio, with its arguments
 *
 * Names of topics, services, actions and nodes stand in backticks with their slash, as `/chatter`:
 * a test looks whether the demo's code, or that of one which it needs, has them.
 */

/** @import { Asked } from "./wire.js" */
/** @import { Command, PressKey } from "../types/wire.d.ts" */
/** @import { MessageForm } from "./state/message-forms.js" */

import { readLesson } from "../lib/lesson-text.js";
import { textFiles } from "../lib/text-files.js";
import { ask } from "./actions.js";
import { layoutDesk } from "./layouts.js";
import { openNamed } from "./start-lists.js";
import { askLessons, chosenLesson, demoCode, lessonTexts, underWay } from "./state/lessons.js";
import { goalForm, publishForm, serviceForm } from "./state/message-forms.js";
import { chooseNode } from "./state/parameters.js";
import { chosenTopic } from "./state/topics.js";

const known = textFiles(new URL("../lessons/", import.meta.url).href, (text) => ({
  ...readLesson(text),
  text,
}));

/** Have the texts of some demos in a language. @param {string} language @param {readonly string[]} demos */
export async function fetchLessons(language, demos) {
  const texts = await Promise.all(demos.map((demo) => known(`${language}/${demo}.md`)));
  lessonTexts.value = new Map(texts.map((text, at) => [demos[at] ?? "", text]));
}

/** Have the code of a demo, once. @param {string} demo */
export async function fetchCode(demo) {
  if (demoCode.peek().has(demo)) return;
  const told = await ask({ type: "get_demo_code", demo });
  if (told?.type === "demo_code") demoCode.value = new Map(demoCode.peek()).set(demo, told.files);
}

/** @param {Asked<Command>} command and look what became of it */
async function askAndLook(command) {
  await ask(command);
  await askLessons();
}

/** Start demos one after the other, until one is refused. @param {readonly string[]} demos */
export async function startDemos(demos) {
  for (const demo of demos) if (!(await ask({ type: "start_demo", demo }))) break;
  await askLessons();
}

/** @param {string} demo */
export const stopDemo = (demo) => askAndLook({ type: "stop_demo", demo });

/** All that run. */
export async function stopAllDemos() {
  await Promise.all(underWay.peek().map((demo) => ask({ type: "stop_demo", demo })));
  await askLessons();
}

/** @param {string} demo @param {PressKey["pressed"]} pressed */
export const pressKey = (demo, pressed) => ask({ type: "press_key", demo, pressed });

/** @type {Record<string, MessageForm>} */
const FORMS = { services: serviceForm, actions: goalForm, publish: publishForm };

/** Where a link of a lesson leads, with the lesson kept in sight. @param {string} panel @param {readonly string[]} about a name, and perhaps its type */
export function followLink(panel, [name = "", type = "", ...more]) {
  if (panel === "open") {
    void openNamed({ type: "open_example", name, arguments: argumentsOf([type, ...more]) });
    return;
  }
  if (name !== "" && panel === "lessons") chosenLesson.value = name;
  if (name !== "" && panel === "topics") chosenTopic.value = name;
  if (name !== "" && panel === "parameters") chooseNode(name);
  if (type !== "") void FORMS[panel]?.open({ name, type });
  layoutDesk.value?.showBeside(panel, "lessons");
}

/** @param {readonly string[]} words each `name:=value` @returns {Record<string, string>} */
const argumentsOf = (words) =>
  Object.fromEntries(words.filter(Boolean).map((word) => word.split(/:=(.*)/s).slice(0, 2)));
