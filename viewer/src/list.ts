// The ranked list. Only the rows in view exist, so that thousands cost nothing.
import type {ToleranceAxis} from "./axis";
import type {Row} from "./choose";
import {h, onNextFrame} from "./dom";
import {kindWord, number, symbol, type Words} from "./words";

const kRowHeight = 58; // as in style.css

export class List {
  readonly element: HTMLElement;
  private readonly spacer = h("div", {class: "spacer"});
  private rows: Row[] = [];
  private selected: number | null = null;
  private readonly ask = onNextFrame(() => this.draw());

  constructor(
    private readonly axis: ToleranceAxis, private readonly words: Words,
    private readonly choose: (id: number) => void, private readonly fold: (id: number) => void) {
    this.element = h("div", {class: "rows", role: "listbox", tabindex: "0", "aria-label": "Symmetries, best first"}, this.spacer);
    this.element.addEventListener("scroll", () => this.ask());
    new ResizeObserver(() => this.ask()).observe(this.element);
  }

  show(rows: Row[], selected: number | null): void {
    this.rows = rows;
    this.selected = selected;
    this.spacer.style.height = `${rows.length * kRowHeight}px`;
    this.draw();
  }

  reveal(id: number): void {
    const i = this.rows.findIndex((row) => row.symmetry.id === id);
    if (i < 0) return;
    const {scrollTop, clientHeight} = this.element;
    if (i * kRowHeight < scrollTop) this.element.scrollTop = i * kRowHeight;
    else if ((i + 1) * kRowHeight > scrollTop + clientHeight) this.element.scrollTop = (i + 1) * kRowHeight - clientHeight;
    this.draw();
  }

  private draw(): void {
    const {scrollTop, clientHeight} = this.element;
    const first = Math.max(0, Math.floor(scrollTop / kRowHeight) - 4);
    const last = Math.min(this.rows.length, Math.ceil((scrollTop + clientHeight) / kRowHeight) + 4);
    const items: HTMLElement[] = [];
    for (let i = first; i < last; ++i) items.push(this.item(this.rows[i], i));
    this.spacer.replaceChildren(...items);
    if (this.rows.length === 0) this.spacer.replaceChildren(h("p", {class: "none"}, "Nothing matches. Esc clears the filters."));
    this.element.setAttribute("aria-activedescendant", this.selected === null ? "" : `row-${this.selected}`);
  }

  private item(row: Row, i: number): HTMLElement {
    const s = row.symmetry;
    const [from, to] = this.axis.bar(s);
    const bar = h("span", {class: "bar"});
    bar.style.left = `${100 * from}%`;
    bar.style.width = `${100 * Math.max(0.012, to - from)}%`;
    const track = h("span", {class: "track", title: `holds for tolerances ${this.words.interval(s)}`}, bar);
    if (this.axis.level !== null) {
      const line = h("span", {class: "at"});
      line.style.left = `${100 * this.axis.x(this.axis.level)}%`;
      track.append(line);
    }
    const fold = row.folded > 0 && h("button", {
      class: "fold", title: `${row.folded} that follow from it`, "aria-expanded": String(row.open),
      click: (event: Event) => {
        event.stopPropagation();
        this.fold(s.id);
      },
    }, `${row.open ? "▾" : "▸"} ${row.folded}`);
    const item = h("div", {
      class: "row" + (row.implied ? " implied" : "") + (s.id === this.selected ? " selected" : ""),
      id: `row-${s.id}`, role: "option", "aria-selected": String(s.id === this.selected),
      click: () => this.choose(s.id),
    },
    h("span", {class: "rank"}, String(s.id)),
    h("span", {class: `badge kind-${s.type}`}, symbol(s)),
    h("span", {class: "what", title: this.words.where(s)}, h("b", {}, kindWord(s)), h("small", {}, " " + this.words.where(s))),
    h("span", {class: "figures"},
      h("span", {class: "count"}, this.words.cycles(s).replace("points", "pts")),
      h("span", {title: "significance: log10 of how many as good chance would give"},
        `sig. ${s.significance === null ? "?" : number(s.significance, 3)}`),
      h("span", {title: "largest distance of an image from its point"}, `dev. ${this.words.deviation(s.deviation.max)}`)),
    fold || h("span", {class: "fold"}),
    track);
    item.style.top = `${i * kRowHeight}px`;
    return item;
  }
}
