/** What the palette offers of the owner's packages: nodes to run and launch files to open. */

/** @import { Choice } from "./palette-choices.js" */

import { t } from "../lib/i18n.js";
import { baseName } from "../lib/paths.js";
import { bareCommand, shellWords } from "../lib/ros2-lines.js";
import { mayRun, openLaunch, packages, showRun, startNode } from "../model/programs.js";

/** @param {string} name of a package @param {string} executable @param {readonly string[]} words behind it */
async function run(name, executable, words) {
  const number = await startNode(name, executable, words);
  if (number > 0) showRun(number);
}

/**
 * @param {string} text that was typed, as `ros2 run PACKAGE EXECUTABLE` or `ros2 launch PACKAGE FILE`
 * @returns {Choice[]} the real thing, where it may be run; a name that is begun finds all that begin so
 */
export function programChoices(text) {
  if (!mayRun.value) return [];
  const [first, verb, name = "", what = "", ...words] = shellWords(bareCommand(text)) ?? [];
  if (first !== "ros2" || name === "") return [];
  const meant = packages.value.filter((one) => one.may_run && one.name.startsWith(name));
  if (verb === "run")
    return meant.flatMap((one) =>
      one.executables
        .filter((each) => each.language !== "c++" && each.name.startsWith(what))
        .map((each) => ({
          rank: "ros2",
          key: `run ${one.name} ${each.name}`,
          icon: "animate",
          label: ["ros2 run", one.name, each.name, ...words].join(" "),
          hint: t("panel.launch"),
          does: t("palette.does.run"),
          run: () => void run(one.name, each.name, words),
        })),
    );
  if (verb !== "launch") return [];
  return meant.flatMap((one) =>
    one.launch_files
      .filter(({ file }) => baseName(file).startsWith(what))
      .map(({ file }) => ({
        rank: "ros2",
        key: `launch ${file}`,
        icon: "launch",
        label: `ros2 launch ${one.name} ${baseName(file)}`,
        hint: t("panel.launch"),
        does: t("palette.does.launch"),
        run: () => openLaunch(file, argumentsOf(words)),
      })),
  );
}

/** @param {readonly string[]} words each `name:=value` @returns {Record<string, string>} */
export const argumentsOf = (words) =>
  Object.fromEntries(
    words.filter((word) => word.includes(":=")).map((word) => word.split(/:=(.*)/s).slice(0, 2)),
  );
