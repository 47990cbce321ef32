/** Which package needs which: drawn as the node graph is. */

/** @import { WorkspaceView } from "../../types/wire.d.ts" */
/** @import { Arrow, Box } from "../graph/nodes.js" */

import { html, useSignal } from "vendor/preact.js";
import { t } from "../../lib/i18n.js";
import { EmptyState } from "../../lib/ui.js";
import { GraphDrawing } from "../graph/drawing.js";

/** @param {{all: readonly WorkspaceView[]}} props */
export function PackageGraph({ all }) {
  const chosen = useSignal("");
  const withRos = useSignal(false);
  const drawn = dependencyDrawing(all, withRos.value);
  const cycles = all.flatMap(({ graph }) => graph.cycles);
  const unknown = all.flatMap(({ graph }) =>
    graph.nodes.filter(({ presence }) => presence === "unknown").map(({ name }) => name),
  );
  return html`<div class="packages-graph">
    <label class="packages-all"><input type="checkbox" checked=${withRos.value} onChange=${(
      /** @type {any} */ event,
    ) => {
      withRos.value = event.currentTarget.checked;
    }} /><span>${t("packages.graph.all")}</span></label>
    ${cycles.map((names) => html`<p key=${names.join(" ")} class="note bad padded" role="alert">${t("packages.cycle", { names: names.join(", ") })}</p>`)}
    ${unknown.length > 0 && html`<p class="note padded">${t("packages.unknown", { names: [...new Set(unknown)].join(", ") })}</p>`}
    ${drawn.boxes.length === 0 ? html`<${EmptyState} icon="package" title=${t("packages.none")} />` : html`<${GraphDrawing} drawn=${drawn} asked=${String(withRos.value)} rates=${new Map()} chosen=${chosen} onFocus=${() => {}} />`}
  </div>`;
}

/**
 * @param {readonly WorkspaceView[]} all
 * @param {boolean} withRos whether packages of ROS and of the system are drawn, too; unknown ones always are
 * @returns {{boxes: Box[], arrows: Arrow[]}} from who needs to who is needed
 */
export function dependencyDrawing(all, withRos) {
  const nodes = all.flatMap(({ graph }) => graph.nodes);
  const shown = nodes.filter(({ presence }) => withRos || MEANT.includes(presence));
  const boxes = new Map(shown.map((one) => [one.name, boxOf(one)]));
  const edges = all.flatMap(({ graph }) => graph.edges);
  const arrows = new Map(
    edges.flatMap(({ package: from, needs }) => {
      const [source, target] = [boxes.get(from)?.id, boxes.get(needs)?.id];
      if (!source || !target) return [];
      const id = `${source} ${target}`;
      return [[id, { id, from: source, to: target, names: [needs] }]];
    }),
  );
  return { boxes: [...boxes.values()], arrows: [...arrows.values()] };
}

const MEANT = ["workspace", "unknown"];
/** How a package is drawn, by where it is. @type {Record<string, Box["kind"]>} */
const KINDS = { workspace: "node", unknown: "action" };

/** @param {WorkspaceView["graph"]["nodes"][number]} node @returns {Box} */
function boxOf({ name, presence }) {
  const kind = KINDS[presence] ?? "topic";
  return { id: `${kind}:${name}`, kind, name, count: 1 };
}
