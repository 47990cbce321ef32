/** The parameters of nodes: listed with what the node says of them, set, written down and loaded, live. */

/** @import { ParameterView } from "../../types/wire.d.ts" */

import { html, useEffect, useSignal } from "vendor/preact.js";
import { saveAsFile } from "../../lib/files.js";
import { t } from "../../lib/i18n.js";
import { TextBox } from "../../lib/slider.js";
import { Icon, IconButton, SearchBox, Switch } from "../../lib/ui.js";
import { mayAct } from "../../model/connection.js";
import { plainOf } from "../../model/operations.js";
import {
  askNodes,
  askParameters,
  chooseNode,
  chosenNode,
  followNodes,
  followParameters,
  nodesRefused,
  parameterNodes,
  parameters,
  parametersRefused,
  setParameter,
  setRefused,
} from "../../model/parameters.js";
import { ask } from "../../model/requests.js";
import { notify } from "../../model/view.js";
import { OperationPanel } from "../operation-panel.js";
import { NothingThere, Refusal } from "../parts.js";

const FOLLOW = [followNodes, followParameters];

export function ParametersPanel() {
  const take = (/** @type {{name: string}} */ { name }) => chooseNode(name);
  return html`<${OperationPanel} id="parameters" icon="parameters" kind="param" follow=${FOLLOW} onLine=${take}>
    ${() => html`<div class=${`operations-parts ${chosenNode.value ? "chosen" : ""}`}><${Nodes} />${chosenNode.value && html`<${Node} node=${chosenNode.value} />`}</div>`}
  <//>`;
}

function Nodes() {
  const filter = useSignal("");
  const nodes = parameterNodes.value;
  const shown = (nodes ?? []).filter((name) =>
    name.toLowerCase().includes(filter.value.toLowerCase()),
  );
  return html`<div class="operations-list">
    <div class="panel-bar"><${SearchBox} label=${t("parameters.nodes.filter")} value=${filter.value} onInput=${(
      /** @type {string} */ text,
    ) => {
      filter.value = text;
    }} /></div>
    ${nodesRefused.value && html`<${Refusal} sentence=${nodesRefused.value} again=${askNodes} />`}
    ${nodes && shown.length === 0 && html`<${NothingThere} icon="parameters" title=${t(nodes.length > 0 ? "operations.filtered" : "parameters.none")} />`}
    ${
      shown.length > 0 &&
      html`<ul class="scroll offers" aria-label=${t("parameters.nodes")}>${shown.map(
        (name) =>
          html`<li key=${name}><button type="button" class="offer" aria-pressed=${name === chosenNode.value} onClick=${() => chooseNode(name)}><span class="offer-name">${name}</span></button></li>`,
      )}</ul>`
    }
  </div>`;
}

/** @param {{node: string}} props the node that is chosen */
function Node({ node }) {
  const filter = useSignal("");
  const known = parameters.value;
  const shown = (known ?? []).filter(({ name }) =>
    name.toLowerCase().includes(filter.value.toLowerCase()),
  );
  return html`<div class="operations-chosen scroll">
    <header class="operation-head node-head"><${IconButton} icon="chevronRight" class="operation-back" label=${t("operations.back")} onClick=${() => chooseNode("")} />
      <h3 title=${node}>${node}</h3><${IconButton} icon="reload" label=${t("parameters.again")} onClick=${askParameters} /></header>
    <div class="panel-bar"><${SearchBox} label=${t("parameters.filter")} value=${filter.value} onInput=${(
      /** @type {string} */ text,
    ) => {
      filter.value = text;
    }} /></div>
    ${parametersRefused.value && html`<${Refusal} sentence=${parametersRefused.value} again=${askParameters} />`}
    ${!known && !parametersRefused.value && html`<p class="note padded">${t("loading")}</p>`}
    ${known && shown.length === 0 && html`<p class="note padded">${t(known.length > 0 ? "operations.filtered" : "parameters.empty")}</p>`}
    ${shown.map((one) => html`<${Row} key=${one.name} parameter=${one} />`)}
    <${AsFile} key=${node} node=${node} />
  </div>`;
}

/** @param {{parameter: ParameterView}} props */
function Row({ parameter }) {
  const { name, value_type: type, description, read_only: fixed } = parameter;
  const refused = setRefused.value.get(name);
  const range = rangeWords(parameter);
  return html`<div class="parameter" title=${description || null}>
    <span class="form-name"><span>${name}</span><small>${[type, range, fixed ? t("parameters.fixed") : ""].filter(Boolean).join(" · ")}</small></span>
    <${Value} parameter=${parameter} />
    ${(description || parameter.constraints) && html`<p class="note">${[description, parameter.constraints].filter(Boolean).join(" ")}</p>`}
    ${refused && html`<p class="note bad" role="alert">${refused}</p>`}
  </div>`;
}

/** @param {ParameterView} parameter */
function rangeWords({ low, high, step, value_type: type }) {
  if (low === null || high === null) return "";
  return t(
    step > 0 && !(type === "integer" && step === 1) ? "parameters.range.step" : "parameters.range",
    { low, high, step },
  );
}

/** @param {{parameter: ParameterView}} props */
function Value({ parameter: { name, value, value_type: type, read_only: fixed, step } }) {
  const disabled = fixed || !mayAct.value;
  const plain = plainOf(value);
  const write = (/** @type {string} */ text) => void setParameter(name, text, type);
  if (type === "bool")
    return html`<${Switch} label=${name} checked=${plain === true} disabled=${disabled} onChange=${(/** @type {boolean} */ on) => write(String(on))} />`;
  const isNumber = type === "integer" || type === "double";
  const text = typeof plain === "string" ? plain : JSON.stringify(plain);
  return html`<${TextBox} label=${name} text=${text} class=${isNumber ? "number" : "wide"} disabled=${disabled} number=${isNumber ? Number(plain) : null}
    step=${isNumber ? step || 1 : undefined} invalid=${setRefused.value.has(name)} takesEmpty=${type === "string"} onWrite=${write} />`;
}

/** All as a file: as it is, and one to be loaded. @param {{node: string}} props */
function AsFile({ node }) {
  const text = useSignal("");
  const refused = useSignal(/** @type {readonly {name: string, reason: string}[]} */ ([]));
  useEffect(() => {
    text.value = "";
  }, [node]);
  const dump = async () => {
    const answer = await ask({ type: "dump_parameters", node });
    if (answer?.type === "parameter_dump") text.value = answer.text;
  };
  const load = async () => {
    const answer = await ask({ type: "load_parameters", node, text: text.value });
    if (answer?.type !== "parameters_loaded") return;
    refused.value = answer.refused;
    notify(t("parameters.loaded", { count: answer.count }), { bad: answer.refused.length > 0 });
    await askParameters();
  };
  const save = () =>
    saveAsFile(`${node.slice(1).replaceAll("/", "__")}.yaml`, text.value, "text/yaml");
  return html`<details class="operation-history"><summary>${t("parameters.file")}</summary>
    <div class="operation-actions"><button type="button" class="button small" onClick=${dump}>${t("parameters.dump")}</button>
      <button type="button" class="button small" disabled=${text.value === ""} onClick=${save}><${Icon} name="download" size=${13} />${t("parameters.save")}</button>
      <button type="button" class="button small" disabled=${text.value.trim() === "" || !mayAct.value} onClick=${load}>${t("parameters.load")}</button></div>
    <textarea class="box yaml" rows=${8} spellcheck=${false} aria-label=${t("parameters.file.of", { node })} placeholder=${`${node}:\n  ros__parameters:\n    …`} value=${text.value}
      onInput=${(/** @type {any} */ event) => {
        text.value = event.currentTarget.value;
      }}></textarea>
    ${refused.value.map(({ name, reason }) => html`<p class="note bad" key=${name}>${t("parameters.refused", { name, reason })}</p>`)}
  </details>`;
}
