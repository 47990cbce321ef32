/** @import { Door } from "./door.js" */

/**
 * viser keeps the name of every node that was ever there, with nothing under it: of markers that come
 * under new names all day these become many. Those that are gone are forgotten after the next picture.
 */
export class Removed {
  #door;
  /** @type {Set<string>} */
  #names = new Set();

  /** @param {Door} door */
  constructor(door) {
    this.#door = door;
    door.onMessage(({ type, name }) => {
      if (type === "RemoveSceneNodeMessage" && name) this.#names.add(name);
    });
    door.onPicture(
      () => undefined,
      () => this.#forget(),
    );
  }

  #forget() {
    const nodes = this.#door.mutable?.nodeRefFromName;
    const state = window.__viserSceneTree?.getState();
    if (!nodes || !state) return;
    for (const name of this.#names) {
      if (name in state) this.#names.delete(name);
      else if (!nodes[name]) {
        delete nodes[name];
        this.#names.delete(name);
      }
    }
  }
}
