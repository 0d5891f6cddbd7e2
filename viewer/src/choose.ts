// Which symmetries the list shows: search, kinds, a tolerance level, a point; implied ones folded.
import type {Letter, Report, Symmetry} from "./report";
import {kindWord, symbol, type Words} from "./words";

export interface Filter {
  query: string;
  kinds: Set<Letter>; // empty: all
  level: number | null; // those that hold at this tolerance
  through: number | null; // those with this point
}

export interface Row {
  symmetry: Symmetry;
  implied: boolean; // shown under what implies it
  folded: number; // how many it has under it
  open: boolean;
}

export class Chooser {
  private readonly root = new Map<number, number>(); // of each symmetry: the one that it follows from in the end
  private readonly texts = new Map<number, string>();

  constructor(private readonly report: Report, private readonly words: Words) {
    const known = new Set(report.symmetries.map((s) => s.id));
    for (const s of report.symmetries) {
      const parent = s.implied_by.find((id) => known.has(id) && id !== s.id);
      this.root.set(s.id, parent === undefined ? s.id : this.root.get(parent) ?? parent);
    }
  }

  rootOf(id: number): number {
    return this.root.get(id) ?? id;
  }

  /// Everything that one may search a symmetry by, in small letters.
  private text(s: Symmetry): string {
    let text = this.texts.get(s.id);
    if (text === undefined) {
      const about = new Set<string>();
      for (const cycle of s.cycles)
        for (const i of cycle.points) {
          const entity = this.report.entities?.[i];
          if (entity) about.add(this.words.entity(entity));
        }
      text = [`#${s.id}`, symbol(s), kindWord(s), s.order ? `order ${s.order}` : "", this.words.where(s), ...about]
        .join(" ").toLowerCase();
      this.texts.set(s.id, text);
    }
    return text;
  }

  matches(s: Symmetry, filter: Filter): boolean {
    if (filter.kinds.size > 0 && !filter.kinds.has(s.type)) return false;
    if (filter.level !== null && (s.tolerance.min > filter.level || filter.level > (s.tolerance.max ?? Infinity)))
      return false;
    const point = filter.through;
    if (point !== null && !s.fixed_points.includes(point) && !s.cycles.some((c) => c.points.includes(point)))
      return false;
    // Phrases between commas: all of them.
    return filter.query.toLowerCase().split(",").map((phrase) => phrase.trim())
      .every((phrase) => phrase === "" || this.text(s).includes(phrase));
  }

  rows(filter: Filter, open: Set<number>): Row[] {
    const found = this.report.symmetries.filter((s) => this.matches(s, filter));
    const ids = new Set(found.map((s) => s.id));
    const under = new Map<number, Symmetry[]>();
    const top: Symmetry[] = [];
    for (const s of found) {
      const root = this.rootOf(s.id);
      if (root === s.id || !ids.has(root)) top.push(s);
      else if (under.get(root)?.push(s) === undefined) under.set(root, [s]);
    }
    return top.flatMap((s) => {
      const below = under.get(s.id) ?? [];
      const isOpen = open.has(s.id);
      const row: Row = {symmetry: s, implied: false, folded: below.length, open: isOpen};
      return isOpen ? [row, ...below.map((b): Row => ({symmetry: b, implied: true, folded: 0, open: false}))] : [row];
    });
  }
}
