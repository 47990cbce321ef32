/** The panels as a test reads them: what the `panel.json` of each says. */

/** @import { PanelFile } from "../../../frontend_assets/app/panels.js" */

import { readdirSync, readFileSync } from "node:fs";
import { ICONS } from "../../../frontend_assets/vendor/icons.js";

const FOLDER = new URL("../../../frontend_assets/panels/", import.meta.url);

/** @param {string} id @returns {PanelFile & {words: Record<string, Record<string, string>>}} */
const read = (id) => JSON.parse(readFileSync(new URL(`${id}/panel.json`, FOLDER), "utf8"));

/** By the names of their folders. */
export const PANEL_FILES = Object.fromEntries(
  readdirSync(FOLDER, { withFileTypes: true })
    .filter((entry) => entry.isDirectory())
    .map(({ name }) => [name, read(name)]),
);
export const PANEL_IDS = Object.keys(PANEL_FILES);

/** Names of all icons: those that many use, and the panels' own. */
export const ICON_NAMES = [
  ...Object.keys(ICONS),
  ...PANEL_IDS.filter((id) => typeof PANEL_FILES[id]?.icon !== "string"),
];
