/** Logging everybody out, and whoever asks for it as well. */

import { t } from "../lib/i18n.js";
import { goTo } from "./actions.js";
import { dialog, notify } from "./state/view.js";

export function askToLogOut() {
  dialog.value = {
    kind: "confirm",
    title: t("log_out"),
    text: t("log_out.text"),
    action: t("log_out.action"),
    danger: true,
    run: () => void logOut(),
  };
}

async function logOut() {
  const answer = await fetch("/api/log-out", { method: "POST" }).catch(() => null);
  // Its front page turns this browser away, and says how to come back.
  if (answer?.ok) goTo("");
  else notify(answer?.status === 409 ? t("log_out.no_token") : t("log_out.failed"), { bad: true });
}
