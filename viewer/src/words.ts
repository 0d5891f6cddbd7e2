// What the page says about a symmetry, an entity, a number.
import {type Entity, type Letter, moves, type Report, type Symmetry, turns} from "./report";

export const kLetters: Letter[] = ["M", "I", "C", "T", "Z", "S", "W"];

export const kKindWords: Record<Letter, string> = {
  M: "mirror",
  I: "inversion",
  C: "rotation",
  T: "translation",
  Z: "glide reflection",
  S: "rotation-reflection",
  W: "screw",
};

export function kindWord(s: Symmetry): string {
  return s.type === "C" && s.order === 2 ? "half-turn" : kKindWords[s.type];
}

export function symbol(s: Symmetry): string {
  return s.order !== null && turns(s) ? s.type + s.order : s.type;
}

export function number(x: number, digits = 4): string {
  if (x === 0) return "0";
  const size = Math.abs(x);
  const rounded = Number(x.toPrecision(digits));
  const text = size >= 1e6 || size < 1e-4 ? rounded.toExponential().replace("e+", "e") : String(rounded);
  return text.replaceAll("-", "−");
}

export function counted(count: number, what: string): string {
  return `${count} ${what}${count === 1 ? "" : "s"}`;
}

export class Words {
  private readonly unit: string;
  readonly plane: string; // in 2D a mirror is a line
  constructor(private readonly report: Report) {
    this.unit = report.input.unit ? " " + report.input.unit : "";
    this.plane = report.input.dimension === 2 ? "line" : "plane";
  }

  length(x: number): string {
    return number(x) + this.unit;
  }

  /// A length below the resolution is none.
  deviation(x: number): string {
    return x <= this.report.options.resolution ? "exact" : number(x, 2) + this.unit;
  }

  interval(s: Symmetry): string {
    const {min, max} = s.tolerance;
    const from = min <= this.report.options.resolution ? "exact" : number(min);
    return `${from} – ${max === null ? "∞" : number(max)}${max === null && from === "exact" ? "" : this.unit}`;
  }

  place(p: number[]): string {
    const small = this.report.options.resolution;
    return `(${p.map((x) => number(Math.abs(x) < small ? 0 : x)).join(", ")})`;
  }

  direction(d: number[]): string {
    const names = ["x", "y", "z"];
    const main = d.findIndex((x) => Math.abs(x) > 1 - 1e-5); // a quarter of a degree
    if (main >= 0) return (Math.abs(d[main]) > 1 - 1e-9 ? "" : "≈ ") + names[main];
    return `(${d.map((x) => number(Math.abs(x) < 1e-9 ? 0 : x, 3)).join(", ")})`;
  }

  /// How a row counts its cycles: 7 × 7 where all are alike.
  cycles(s: Symmetry): string {
    const sizes = s.cycles.map((cycle) => cycle.points.length);
    const points = new Set(s.cycles.flatMap((cycle) => cycle.points)).size;
    if (sizes.length === 0) return "";
    if (sizes.every((size) => size === sizes[0])) return `${sizes.length} × ${sizes[0]} points`;
    return `${sizes.length} cycles, ${points} points`;
  }

  where(s: Symmetry): string {
    const {axis, plane, center, angle_deg, step} = s.isometry;
    const parts: string[] = [];
    if (turns(s)) parts.push(`${number(angle_deg)}°`);
    if (moves(s)) parts.push(`step ${this.length(step)}`);
    if (axis) parts.push(`axis ${this.direction(axis.direction)}`);
    else if (center) parts.push(`centre ${this.place(center)}`);
    if (plane) parts.push(`${this.plane} ⊥ ${this.direction(plane.normal)}`);
    return parts.join(", ");
  }

  /// "face 12", "edges 3, 4": what a CAD program calls it.
  entityIds(e: Entity): string {
    const ids = e.ids && e.ids.length > 1 ? e.ids : [e.id];
    return `${e.kind}${ids.length > 1 ? "s" : ""} ${ids.join(", ")}`;
  }

  entity(e: Entity): string {
    const size = e.radius ? `, radius ${this.length(e.radius)}` : e.length ? `, ${this.length(e.length)} long` : "";
    const what = e.role && e.role !== "none" ? `${e.geometry} (${e.role})` : e.geometry;
    return `${what}${size}${e.part ? `, in ${e.part}` : ""}`;
  }

  point(i: number): string {
    const entity = this.report.entities?.[i];
    return entity ? this.entityIds(entity) : `point ${i}`;
  }

  pointDetail(i: number): string {
    const entity = this.report.entities?.[i];
    const label = this.report.labels && !entity ? `, label ${this.report.labels[i]}` : "";
    return (entity ? this.entity(entity) + " " : "") + `at ${this.place(this.report.points[i])}${label}`;
  }
}
