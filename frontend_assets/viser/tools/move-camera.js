import { Tool } from "./tool.js";

/** Every press is the camera's; nothing is selected or dragged. */
export class MoveCamera extends Tool {}
