// The page: what is chosen, and who has to know.
import {ToleranceAxis} from "./axis";
import {Chooser, type Filter, type Row} from "./choose";
import {Detail} from "./detail";
import {h} from "./dom";
import {List} from "./list";
import {Player} from "./player";
import {type Letter, readModel, readReport, type Symmetry} from "./report";
import {Stage} from "./stage";
import "./style.css";
import {counted, kKindWords, kLetters, Words} from "./words";

const kKeys: [string, string][] = [
  ["↑ ↓", "previous, next symmetry"], ["Home End", "first, last"], ["→ ←", "unfold, fold what follows from it"],
  ["space", "carry the model through it"], ["a", "look along its axis"], ["f", "first view"], ["/", "search"],
  ["1 … 7", "filter by kind"], ["t", "dark or light"], ["Esc", "clear filters, then the choice"], ["?", "this list"],
];

const element = (id: string) => document.getElementById(id) as HTMLElement;
const report = readReport();
const words = new Words(report);
const byId = new Map(report.symmetries.map((s) => [s.id, s]));
const chooser = new Chooser(report, words);
const stage = new Stage(element("canvas") as HTMLCanvasElement, report, readModel());

const filter: Filter = {query: "", kinds: new Set<Letter>(), level: null, through: null};
const open = new Set<number>();
let selected: Symmetry | null = null;
let picked: number | null = null;
let rows: Row[] = [];
let dark = matchMedia("(prefers-color-scheme: dark)").matches;

const axis = new ToleranceAxis(report, words, () => {
  filter.level = axis.level;
  showList();
});
const list = new List(axis, words, (id) => select(id), (id) => toggleFold(id));
const player = new Player((t) => stage.setTime(t));
const detail = new Detail(element("detail"), report, words, {
  select: (id) => select(id),
  point: (i) => pick(i, false),
  through: (i) => pick(i, true),
});

// The parts of the page ----------------------------------------------------------------------------

const search = h("input", {
  type: "search", placeholder: "Search, as in: mirror, hole", "aria-label": "Search",
  input: () => {
    filter.query = search.value;
    showList();
  },
});
const chips = new Map<Letter, HTMLButtonElement>();
const count = h("p", {class: "found", "aria-live": "polite"});
const help = h("dialog", {class: "help"}, h("h2", {}, "Keys"),
  h("dl", {}, ...kKeys.flatMap(([key, what]) => [h("dt", {}, key), h("dd", {}, what)])),
  h("p", {}, "Drag turns, the wheel zooms, the right button moves. A click on a point or face lists its symmetries."),
  h("p", {class: "legend"}, "Discs: points of the cycles. Rings: fixed points. Broken rings and ghosts: empty slots of the pattern."),
  h("form", {method: "dialog"}, h("button", {}, "close")));

function facts(): string {
  const {input, options, status, generator} = report;
  const shown = report.symmetries.length;
  const all = report.stats.symmetries;
  return [
    `${report.points.length} points${report.entities ? ` (${options.points})` : ""} in ${input.dimension}D`,
    `diameter ${words.length(input.diameter)}`,
    shown < all ? `the first ${shown} of ${all} symmetries` : `${all} symmetries`,
    `tolerance up to ${words.length(options.max_tolerance)}`,
    report.group && report.group.schoenflies !== "C1" ? `point group ${report.group.schoenflies}${report.group.empty_slots > 0 ? ` but for ${counted(report.group.empty_slots, "empty slot")}` : ""}` : "",
    status === "complete" ? "" : `stopped early: ${status.replace("_", " ")}`,
    `${generator.name} ${generator.version}`,
  ].filter((text) => text !== "").join(" · ");
}

function build(): void {
  const name = report.input.path === "-" ? "standard input" : report.input.path.split("/").pop() ?? "";
  document.title = `${name} – symmetries`;
  element("head").append(
    h("div", {}, h("h1", {title: report.input.path}, name), h("p", {class: "facts"}, facts())),
    h("div", {class: "buttons"},
      h("button", {class: "icon", title: "Dark or light (t)", click: () => setTheme(!dark)}, "◐"),
      h("button", {class: "icon", title: "Keys (?)", click: () => help.showModal()}, "?")));
  const kinds = h("div", {class: "chips", role: "group", "aria-label": "Kinds"});
  for (const letter of kLetters) {
    const number = report.symmetries.filter((s) => s.type === letter).length;
    if (number === 0) continue;
    const chip = h("button", {
      class: `chip kind-${letter}`, title: kKindWords[letter], "aria-pressed": "false", click: () => toggleKind(letter),
    }, h("b", {}, letter), ` ${kKindWords[letter]} `, h("small", {}, String(number)));
    chips.set(letter, chip);
    kinds.append(chip);
  }
  element("list").append(h("div", {class: "filters"}, search, kinds, axis.element, count), list.element);
  element("stage").append(h("div", {class: "controls"},
    player.element,
    h("div", {class: "views"},
      h("button", {title: "Look along the axis (a)", click: () => stage.lookAlong()}, "along axis"),
      h("button", {title: "First view (f)", click: () => stage.home()}, "reset"))));
  const tabs = [["list", "List"], ["detail", "Details"]].map(([name, text]) =>
    h("button", {"data-tab": name, click: () => showTab(name)}, text));
  element("tabs").append(...tabs);
  document.body.append(help);
}

function showTab(name: string): void {
  document.body.dataset.tab = name;
  for (const tab of element("tabs").children) tab.setAttribute("aria-pressed", String((tab as HTMLElement).dataset.tab === name));
}

// What changes -------------------------------------------------------------------------------------

function showList(): void {
  rows = chooser.rows(filter, open);
  list.show(rows, selected?.id ?? null);
  const found = rows.reduce((sum, row) => sum + 1 + (row.open ? 0 : row.folded), 0);
  const folded = rows.reduce((sum, row) => sum + (row.open ? 0 : row.folded), 0);
  count.replaceChildren(
    found === report.symmetries.length ? `${found} symmetries` : `${found} of ${report.symmetries.length} symmetries`,
    folded > 0 ? `, ${folded} folded under what implies them` : "");
  if (filter.through !== null)
    count.append(" through ", h("button", {class: "chip on", title: "Clear", click: () => pick(null, false)}, `${words.point(filter.through)} ✕`));
}

function showDetail(): void {
  const implies = selected ? report.symmetries.filter((s) => s.implied_by.includes(selected!.id)).map((s) => s.id) : [];
  detail.show(selected, picked, implies, dark);
}

function select(id: number | null): void {
  selected = id === null ? null : byId.get(id) ?? null;
  stage.show(selected);
  player.reset();
  if (!selected) player.stop();
  const root = selected ? chooser.rootOf(selected.id) : null;
  if (selected && root !== null && root !== selected.id) open.add(root);
  showList();
  if (selected) list.reveal(selected.id);
  showDetail();
  document.body.classList.toggle("chosen", selected !== null);
}

/// `lists`: the list shows only the symmetries through the point.
function pick(point: number | null, lists: boolean): void {
  if (lists && point === null) picked = filter.through = null;
  else {
    picked = point;
    filter.through = lists ? point : point === null ? null : filter.through;
  }
  stage.markPoint(picked);
  showList();
  showDetail();
}

function toggleFold(id: number, to = !open.has(id)): void {
  if (to) open.add(id);
  else open.delete(id);
  showList();
}

function toggleKind(letter: Letter): void {
  if (!filter.kinds.delete(letter)) filter.kinds.add(letter);
  for (const [kind, chip] of chips) {
    chip.classList.toggle("on", filter.kinds.has(kind));
    chip.setAttribute("aria-pressed", String(filter.kinds.has(kind)));
  }
  showList();
}

function setTheme(to: boolean): void {
  dark = to;
  document.documentElement.dataset.theme = dark ? "dark" : "light";
  stage.setTheme(dark);
  axis.drawChart();
  showDetail();
}

function clearOne(): void {
  if (filter.query || filter.kinds.size > 0 || filter.level !== null || filter.through !== null || picked !== null) {
    filter.query = search.value = "";
    for (const letter of [...filter.kinds]) toggleKind(letter);
    axis.set(null);
    pick(null, true);
  } else {
    select(null);
  }
}

// Keyboard and pointer -----------------------------------------------------------------------------

function step(by: number): void {
  if (rows.length === 0) return;
  const at = rows.findIndex((row) => row.symmetry.id === selected?.id);
  const next = at < 0 ? (by > 0 ? 0 : rows.length - 1) : Math.min(rows.length - 1, Math.max(0, at + by));
  select(rows[next].symmetry.id);
}

const kActions: Record<string, () => void> = {
  ArrowDown: () => step(1),
  ArrowUp: () => step(-1),
  PageDown: () => step(10),
  PageUp: () => step(-10),
  Home: () => step(-Infinity),
  End: () => step(Infinity),
  ArrowRight: () => selected && toggleFold(selected.id, true),
  ArrowLeft: () => selected && toggleFold(chooser.rootOf(selected.id), false),
  " ": () => selected && player.toggle(),
  a: () => stage.lookAlong(),
  f: () => stage.home(),
  t: () => setTheme(!dark),
  "/": () => search.focus(),
  "?": () => help.showModal(),
  Escape: clearOne,
};

document.addEventListener("keydown", (event) => {
  if (event.ctrlKey || event.metaKey || event.altKey || help.open) return;
  const target = event.target as HTMLElement;
  if (target instanceof HTMLInputElement) {
    if (event.key === "Escape") target.blur();
    if (event.key === "Escape" || (target === search && (event.key === "ArrowDown" || event.key === "Enter"))) list.element.focus();
    else return;
  }
  if (event.key === " " && target instanceof HTMLButtonElement) return; // presses the button
  const kind = kLetters[Number(event.key) - 1];
  const action = kind && chips.has(kind) ? () => toggleKind(kind) : kActions[event.key];
  if (!action) return;
  event.preventDefault();
  action();
});

const canvas = element("canvas");
let down: {x: number; y: number} | null = null;
canvas.addEventListener("pointerdown", (event) => (down = {x: event.clientX, y: event.clientY}));
canvas.addEventListener("pointerup", (event) => {
  if (!down || Math.hypot(event.clientX - down.x, event.clientY - down.y) > 4) return;
  const box = canvas.getBoundingClientRect();
  const point = stage.pointAt(event.clientX - box.left, event.clientY - box.top);
  if (point !== null) pick(point, true);
});

build();
showTab("list");
setTheme(dark);
showList();
if (report.symmetries.length > 0) select(report.symmetries[0].id);

// For tests and for people with a console.
Object.assign(window, {insym: {report, stage, select}});
