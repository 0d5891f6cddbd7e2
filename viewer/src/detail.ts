// Everything about the chosen symmetry and the chosen point.
import {copy, h} from "./dom";
import {orbitColour} from "./palette";
import {moves, type Report, type Symmetry, turns} from "./report";
import {kindWord, number, symbol, type Words} from "./words";

const kMostCycles = 100;
const kMostPoints = 60; // of a cycle
const kMostLinks = 12; // to other symmetries

export interface DetailActions {
  select(id: number): void;
  point(i: number): void;
  through(i: number | null): void;
}

function button(text: string, click: (event: Event) => void, title = ""): HTMLButtonElement {
  return h("button", {class: "quiet", click, title}, text);
}

function copyButton(text: string, what: () => string, title = ""): HTMLButtonElement {
  const made: HTMLButtonElement = button(text, () => void copy(what(), made), title);
  return made;
}

function table(lines: [string, Node | string | null][]): HTMLElement {
  return h("dl", {}, ...lines.flatMap(([name, value]) => (value ? [h("dt", {}, name), h("dd", {}, value)] : [])));
}

export class Detail {
  constructor(
    private readonly element: HTMLElement, private readonly report: Report, private readonly words: Words,
    private readonly actions: DetailActions) {}

  show(s: Symmetry | null, point: number | null, implies: number[], dark: boolean): void {
    this.element.replaceChildren(...[
      point === null ? null : this.point(point),
      s ? this.symmetry(s, implies, dark) : h("p", {class: "hint"}, "Choose a symmetry in the list, or click a point."),
    ].filter((node): node is HTMLElement => node !== null));
    this.element.scrollTop = 0;
  }

  private point(i: number): HTMLElement {
    const entity = this.report.entities?.[i];
    return h("section", {class: "point"},
      h("h2", {}, this.words.point(i)),
      h("p", {}, this.words.pointDetail(i)),
      h("div", {class: "buttons"},
        button("all symmetries", () => this.actions.through(null), "List all symmetries again"),
        copyButton("copy id", () => (entity ? this.words.entityIds(entity) : String(i)))));
  }

  private symmetry(s: Symmetry, implies: number[], dark: boolean): HTMLElement {
    const {axis, plane, center, angle_deg, step, matrix} = s.isometry;
    const links = (ids: number[]) => h("span", {class: "links"},
      ...ids.slice(0, kMostLinks).map((id) => button(`#${id}`, () => this.actions.select(id))),
      ids.length > kMostLinks ? `… ${ids.length - kMostLinks} more` : "");
    const w = this.words;
    return h("section", {},
      h("h2", {}, h("span", {class: `badge kind-${s.type}`}, symbol(s)),
        ` ${kindWord(s)}${s.order && s.order > 2 ? ` of order ${s.order}` : ""} `, h("small", {}, `#${s.id}`)),
      table([
        ["turn", turns(s) ? `${number(angle_deg, 6)}°` : null],
        ["step", moves(s) ? w.length(step) : null],
        ["axis", axis && s.type !== "T" ? `${w.direction(axis.direction)} through ${w.place(axis.point)}` : null],
        ["along", axis && s.type === "T" ? w.direction(axis.direction) : null],
        [w.plane, plane ? `⊥ ${w.direction(plane.normal)} through ${w.place(plane.point)}` : null],
        ["centre", center ? w.place(center) : null],
        ["tolerance", w.interval(s)],
        ["deviation", s.deviation.max <= this.report.options.resolution ? "exact" : `${w.length(s.deviation.max)} at most, ${w.length(s.deviation.rms)} rms`],
        ["coverage", `${number(100 * s.coverage, 3)} % of all points`],
        ["significance", s.significance === null ? null : number(s.significance)],
        ["cycles", w.cycles(s)],
        ["fixed points", s.fixed_points.length > 0 ? String(s.fixed_points.length) : null],
        ["empty slots", s.missing.length > 0 ? `${s.missing.length}: ${s.missing.slice(0, 4).map((m) => w.place(m.position)).join(", ")}${s.missing.length > 4 ? ", …" : ""}` : null],
        ["follows from", s.implied_by.length > 0 ? links(s.implied_by) : null],
        ["implies", implies.length > 0 ? links(implies) : null],
      ]),
      h("div", {class: "buttons"},
        copyButton("copy ids", () => s.cycles.map((c) => this.ids(c.points)).join("\n"), "The ids of all entities, a line for each cycle"),
        copyButton("copy matrix", () => JSON.stringify(matrix))),
      h("h3", {}, "Cycles"),
      this.cycles(s, dark));
  }

  private ids(points: number[]): string {
    return points.map((i) => this.words.point(i)).join("; ");
  }

  private cycles(s: Symmetry, dark: boolean, most = kMostCycles): HTMLElement {
    const list = h("ol", {class: "cycles"});
    s.cycles.slice(0, most).forEach((cycle, c) => {
      const swatch = h("i", {class: "swatch"});
      swatch.style.background = `#${orbitColour(c, dark).getHexString()}`;
      const points = cycle.points.slice(0, kMostPoints).flatMap((i, k) => [
        k > 0 ? " → " : "",
        h("button", {class: "id", title: this.words.pointDetail(i), click: () => this.actions.point(i)}, this.words.point(i)),
      ]);
      if (cycle.points.length > kMostPoints) points.push(` … ${cycle.points.length - kMostPoints} more`);
      if (cycle.closed && cycle.points.length > 2) points.push(" ↺");
      list.append(h("li", {}, swatch, ...points, " ", copyButton("copy", () => this.ids(cycle.points))));
    });
    if (s.cycles.length > most)
      list.append(h("li", {}, button(`${s.cycles.length - most} more cycles`, () =>
        list.replaceWith(this.cycles(s, dark, s.cycles.length)))));
    return list;
  }
}
