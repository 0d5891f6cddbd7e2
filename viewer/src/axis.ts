// The tolerance axis: logarithmic, with the number of symmetries that hold at each tolerance, and the level to filter by.
import {h} from "./dom";
import type {Report, Symmetry} from "./report";
import {number, type Words} from "./words";

const kSteps = 400;

export class ToleranceAxis {
  readonly element: HTMLElement;
  private readonly low: number;
  private readonly high: number;
  private readonly slider: HTMLInputElement;
  private readonly value = h("output", {class: "level"});
  private readonly clear: HTMLButtonElement;
  private readonly chart = h("canvas", {class: "chart", "aria-hidden": "true"});
  level: number | null = null;

  constructor(private readonly report: Report, private readonly words: Words, private readonly changed: () => void) {
    const limits = report.symmetries.flatMap((s) => [s.tolerance.min, s.tolerance.max ?? 0]).filter((x) => x > 0);
    const resolution = report.options.resolution;
    this.low = Math.max(resolution, 1e-300);
    this.high = limits.reduce((most, x) => Math.max(most, x), Math.max(report.options.max_tolerance, 10 * this.low));
    this.slider = h("input", {
      type: "range", min: "0", max: String(kSteps), value: "0", "aria-label": "Tolerance level",
      input: () => this.set(this.at(Number(this.slider.value) / kSteps)),
    });
    this.clear = h("button", {class: "quiet", click: () => this.set(null), title: "Show all tolerances"}, "any");
    this.element = h("div", {class: "axis"},
      h("div", {class: "axis-head"}, h("span", {}, "Tolerance"), this.value, this.clear),
      h("div", {class: "axis-body"}, this.chart, this.slider, this.ticks()));
    new ResizeObserver(() => this.drawChart()).observe(this.chart);
    this.show();
  }

  /// 0..1 along the axis.
  x(length: number): number {
    const share = Math.log(Math.max(length, this.low) / this.low) / Math.log(this.high / this.low);
    return Math.min(1, Math.max(0, share));
  }

  private at(x: number): number {
    return this.low * Math.pow(this.high / this.low, x);
  }

  /// Where the bar of a symmetry begins and ends.
  bar(s: Symmetry): [number, number] {
    const {min, max} = s.tolerance;
    return [min <= this.low ? 0 : this.x(min), max === null ? 1 : this.x(max)];
  }

  set(level: number | null): void {
    this.level = level;
    this.slider.value = String(level === null ? 0 : Math.round(this.x(level) * kSteps));
    this.show();
    this.changed();
  }

  private show(): void {
    this.value.textContent = this.level === null ? "any level" : `holds at ${this.words.length(Number(this.level.toPrecision(3)))}`;
    this.clear.hidden = this.level === null;
    this.element.classList.toggle("active", this.level !== null);
  }

  private ticks(): HTMLElement {
    const ticks = h("div", {class: "ticks", "aria-hidden": "true"});
    const first = Math.ceil(Math.log10(this.low) - 1e-9);
    const last = Math.floor(Math.log10(this.high));
    const every = Math.ceil((last - first + 1) / 5);
    for (let e = first; e <= last; e += every) {
      if (this.x(Math.pow(10, e)) < 0.03 || this.x(Math.pow(10, e)) > 0.97) continue; // would stick out
      const tick = h("span", {}, number(Math.pow(10, e)));
      tick.style.left = `${100 * this.x(Math.pow(10, e))}%`;
      ticks.append(tick);
    }
    return ticks;
  }

  drawChart(): void {
    const ratio = window.devicePixelRatio;
    const width = (this.chart.width = Math.max(1, Math.round(this.chart.clientWidth * ratio)));
    const height = (this.chart.height = Math.max(1, Math.round(this.chart.clientHeight * ratio)));
    const changes = new Array<number>(width + 1).fill(0);
    for (const s of this.report.symmetries) {
      const [from, to] = this.bar(s);
      const first = Math.min(width - 1, Math.floor(from * width));
      changes[first] += 1;
      changes[Math.max(first + 1, Math.ceil(to * width))] -= 1;
    }
    const most = changes.reduce(([sum, top], x) => [sum + x, Math.max(top, sum + x)], [0, 0])[1];
    const context = this.chart.getContext("2d") as CanvasRenderingContext2D;
    context.fillStyle = getComputedStyle(this.chart).color;
    let holding = 0;
    for (let x = 0; x < width; ++x) {
      holding += changes[x];
      const tall = most > 0 ? (holding / most) * height : 0;
      context.fillRect(x, height - tall, 1, tall);
    }
  }
}
