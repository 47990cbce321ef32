/** Lets modules of the page be imported here: `vendor/` is where the import map of the page says. */

import { register } from "node:module";

const VENDOR = new URL("../../../frontend_assets/vendor/", import.meta.url).href;
const HOOK = `export const resolve = (name, context, next) =>
  name.startsWith("vendor/") ? next(${JSON.stringify(VENDOR)} + name.slice(7), context) : next(name, context);`;

register(`data:text/javascript,${encodeURIComponent(HOOK)}`);

/** What the modules read of the browser while they are evaluated. */
const BROWSER = {
  matchMedia: () => ({ matches: false, addEventListener() {} }),
  navigator: { platform: "", language: "en" },
};
for (const [name, value] of Object.entries(BROWSER))
  if (!(name in globalThis)) Object.defineProperty(globalThis, name, { value });
