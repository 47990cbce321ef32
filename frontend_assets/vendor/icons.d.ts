/** Shapes of the icons by our own names: SVG tag and attributes. */
export const ICONS: Record<string, [string, Record<string, string>][]>;
