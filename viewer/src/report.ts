// The data in the page: the report (schema insym.report/1) and the model, both moved and scaled for the scene.
import {Matrix4, Vector3} from "three";

export type Letter = "M" | "I" | "C" | "T" | "Z" | "S" | "W";
type Coordinates = number[];

interface Isometry {
  matrix: number[][];
  angle_deg: number;
  step: number;
  axis: {point: Coordinates; direction: Coordinates} | null;
  plane: {point: Coordinates; normal: Coordinates} | null;
  center: Coordinates | null;
}

export interface Cycle {
  points: number[];
  closed: boolean;
}

export interface Symmetry {
  id: number;
  type: Letter;
  order: number | null;
  isometry: Isometry;
  cycles: Cycle[];
  tolerance: {min: number; max: number | null};
  deviation: {rms: number; max: number};
  coverage: number;
  fixed_points: number[];
  missing: {position: Coordinates}[];
  significance: number | null;
  maximal: boolean;
  implied_by: number[];
}

/// Whether it turns about an axis; whether it moves by a step.
export const turns = (s: Symmetry): boolean => "CSW".includes(s.type);
export const moves = (s: Symmetry): boolean => "TZW".includes(s.type);

export interface Entity {
  kind: "vertex" | "edge" | "face";
  id: number;
  geometry: string;
  ids?: number[];
  role?: string;
  radius?: number;
  length?: number;
  area?: number;
  part?: string;
}

export interface Report {
  generator: {name: string; version: string};
  status: string;
  input: {path: string; format: string; unit: string | null; dimension: 2 | 3; diameter: number};
  options: {method: string; resolution: number; max_tolerance: number; points: string};
  points: Coordinates[];
  labels: number[] | null;
  entities: Entity[] | null;
  symmetries: Symmetry[];
  group: {schoenflies: string; hermann_mauguin: string; empty_slots: number} | null;
  stats: {symmetries: number};
  diagnostics: {message: string}[];
}

/// In the unit of the input, relative to `origin`.
export interface Model {
  origin: Coordinates;
  positions: Float32Array;
  normals: Int8Array;
  triangles: Uint32Array;
  faces: Int32Array; // of each triangle: the entity's id
  line_points: Float32Array;
  line_starts: Uint32Array; // into the points; a line ends where the next begins
  line_edges: Int32Array; // the entity's id
}

function parse(id: string): unknown {
  return JSON.parse(document.getElementById(id)?.textContent ?? "null");
}

function bytes(text: string): ArrayBuffer {
  const characters = atob(text);
  const result = new Uint8Array(characters.length);
  for (let i = 0; i < characters.length; ++i) result[i] = characters.charCodeAt(i);
  return result.buffer;
}

export function readReport(): Report {
  return parse("insym-report") as Report;
}

export function readModel(): Model {
  const data = parse("insym-model") as Record<keyof Model, string> & {origin: Coordinates};
  return {
    origin: data.origin,
    positions: new Float32Array(bytes(data.positions)),
    normals: new Int8Array(bytes(data.normals)),
    triangles: new Uint32Array(bytes(data.triangles)),
    faces: new Int32Array(bytes(data.faces)),
    line_points: new Float32Array(bytes(data.line_points)),
    line_starts: new Uint32Array(bytes(data.line_starts)),
    line_edges: new Int32Array(bytes(data.line_edges)),
  };
}

/// From the input's coordinates to those of the scene, in which everything lies in a ball of radius 1 about 0.
export class Frame {
  constructor(private readonly origin: Coordinates, readonly scale: number) {}

  point(p: Coordinates): Vector3 {
    const o = this.origin;
    return new Vector3(p[0] - o[0], p[1] - o[1], (p[2] ?? o[2]) - o[2]).multiplyScalar(this.scale);
  }

  direction(d: Coordinates): Vector3 {
    return new Vector3(d[0], d[1], d[2] ?? 0);
  }

  /// The isometry in the scene; a plane's as one of space.
  matrix(rows: number[][]): Matrix4 {
    const n = rows.length - 1;
    const at = (i: number, j: number) => (i < n && j < n ? rows[i][j] : i === j ? 1 : 0);
    const o = this.origin;
    const shift = [0, 1, 2].map((i) =>
      ((i < n ? rows[i][n] : 0) + at(i, 0) * o[0] + at(i, 1) * o[1] + at(i, 2) * o[2] - o[i]) * this.scale);
    return new Matrix4().set(
      at(0, 0), at(0, 1), at(0, 2), shift[0],
      at(1, 0), at(1, 1), at(1, 2), shift[1],
      at(2, 0), at(2, 1), at(2, 2), shift[2],
      0, 0, 0, 1);
  }
}

export function frameOf(report: Report, model: Model): Frame {
  let radius = 0;
  const o = model.origin;
  for (const p of report.points)
    radius = Math.max(radius, Math.hypot(p[0] - o[0], p[1] - o[1], (p[2] ?? o[2]) - o[2]));
  const x = model.positions;
  for (let i = 0; i < x.length; i += 3) radius = Math.max(radius, Math.hypot(x[i], x[i + 1], x[i + 2]));
  return new Frame(o, radius > 0 ? 1 / radius : 1);
}
