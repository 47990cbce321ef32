/** What vendor/dockview.js exports. */
export { createDockview } from "dockview";
export type {
  DockviewApi,
  DockviewGroupPanel,
  DockviewTheme,
  IContentRenderer,
  IDockviewPanel,
  ITabRenderer,
  SerializedDockview,
} from "dockview";
