/** What this studio publishes at a rate, in the bar below: seen from any panel, and one click from its end. */

import { html, useEffect } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { Icon } from "../lib/ui.js";
import { commandById } from "./commands.js";
import { followDeeds } from "./state/deed-following.js";
import { repeatedPublications } from "./state/deeds.js";
import { ros } from "./state/ros.js";

export function PublishingStatus() {
  const isJoined = ros.value.state === "connected";
  useEffect(() => (isJoined ? followDeeds("publications") : undefined), [isJoined]);
  const all = repeatedPublications.value;
  const [first] = all;
  if (!isJoined || !first) return null;
  const shown =
    all.length === 1
      ? t("publishing.topic", { topic: first.name, rate: first.rate_hz })
      : t("publishing.many", { count: all.length });
  const hint = all.map(({ name, rate_hz: rate }) => t("publishing.topic", { topic: name, rate }));
  return html`<button type="button" class="status-button amber" title=${[...hint, t("publishing.hint")].join("\n")}
    onClick=${() => commandById("panel.publish")?.run()}><${Icon} name="send" size=${13} />${shown}</button>`;
}
