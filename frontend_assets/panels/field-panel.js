/** What panels that draw the world of one demo are made of: which world, or how there comes to be one. */

/** @import { inNamespaces } from "../app/namespaces.js" */

import { html } from "vendor/preact.js";
import { ConnectFirst, isRouterAway, isUnconnected, RouterAway } from "../app/connect-first.js";
import { DemoFirst } from "../app/demo-first.js";
import { useLooking } from "../app/looking.js";
import { mayEdit } from "../app/state/connection.js";
import { t } from "../lib/i18n.js";
import { Icon, MenuButton, ProgressBar } from "../lib/ui.js";

/**
 * @typedef {object} FieldPanelProps
 * @property {string} id of the panel
 * @property {string} icon
 * @property {string} demo that has such a world
 * @property {() => () => void} follow what it needs while it is looked at
 * @property {ReturnType<typeof inNamespaces<any>>} worlds
 * @property {(world: any) => string} nameOf a world
 * @property {(props: {world: any}) => import("vendor/preact.js").VNode} world draws the one that is looked at
 */

/** @param {FieldPanelProps} props */
export function FieldPanel(props) {
  const { id, icon, follow } = props;
  const { panel, looking } = useLooking(follow);
  return html`<section ref=${panel} class=${`panel-body with-field ${id}`} aria-label=${t(`panel.${id}`)}>
    ${isUnconnected() ? html`<${ConnectFirst} icon=${icon} />` : looking && html`<${Content} ...${props} />`}
  </section>`;
}

/** @param {FieldPanelProps} props */
function Content({ id, icon, demo, worlds: { all, shown, chosen }, nameOf, world: World }) {
  if (!all.value) return html`<${ProgressBar} label=${t("loading")} done=${0} total=${0} />`;
  const one = shown.value;
  if (!one && isRouterAway()) return html`<${RouterAway} />`;
  if (!one) return html`<${DemoFirst} icon=${icon} title=${t(`${id}.none`)} demo=${demo} />`;
  const items = () =>
    (all.value ?? []).map((other) => ({
      label: nameOf(other),
      checked: other.prefix === one.prefix,
      run: () => {
        chosen.value = other.prefix;
      },
    }));
  return html`<${RouterAway} />${
    all.value.length > 1 &&
    html`<div class="panel-bar row"><${MenuButton} label=${t(`${id}.choose`)} value=${nameOf(one)} class="button" items=${items}>
      <span class="field-name">${nameOf(one)}</span><${Icon} name="chevronDown" size=${12} /><//></div>`
  }
    ${!mayEdit.value && html`<p class="note padded">${t(`${id}.viewer`)}</p>`}
    <${World} key=${one.prefix} world=${one} />`;
}

/** @param {{troubles: readonly string[]}} props why things were not done; empty ones are none */
export function Troubles({ troubles }) {
  return troubles.map(
    (sentence) =>
      sentence && html`<p key=${sentence} class="note bad padded" role="alert">${sentence}</p>`,
  );
}
