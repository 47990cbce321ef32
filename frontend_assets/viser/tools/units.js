/** In which units the page writes numbers at the mouse. */
export class Units {
  /** @type {"deg" | "rad"} */
  angles = "deg";
  /** @type {"m" | "mm"} */
  lengths = "m";

  /** @param {number} value rad */
  angle(value) {
    if (this.angles === "rad") return `${value.toFixed(3)} rad`;
    return `${((value * 180) / Math.PI).toFixed(1)}°`;
  }

  /** @param {readonly number[]} values m @returns {string} with their unit */
  length(...values) {
    const texts = values.map((value) =>
      this.lengths === "mm" ? (value * 1000).toFixed(0) : value.toFixed(3),
    );
    return `${texts.join("  ")} ${this.lengths}`;
  }
}
