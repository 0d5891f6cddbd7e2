// An isometry as a motion: where it is at time 0..1 on its way from the identity. What it reverses goes flat half way.
import {Matrix4, Quaternion, Vector3} from "three";
import {type Frame, moves, type Symmetry, turns} from "./report";

export type Motion = (t: number) => Matrix4;

interface Elements {
  centre: Vector3;
  axis: Vector3 | null;
  angle: number;
  step: Vector3;
  normal: Vector3 | null; // of the plane that it reflects in
  inverts: boolean;
}

function elementsOf(s: Symmetry, frame: Frame): Elements {
  const {axis, plane, center, angle_deg, step} = s.isometry;
  const centre = center ?? plane?.point ?? axis?.point;
  const direction = axis ? frame.direction(axis.direction) : null;
  return {
    centre: centre ? frame.point(centre) : new Vector3(),
    axis: turns(s) ? direction ?? new Vector3(0, 0, 1) : null,
    angle: turns(s) ? (angle_deg * Math.PI) / 180 : 0,
    step: moves(s) && direction ? direction.clone().multiplyScalar(step * frame.scale) : new Vector3(),
    normal: plane && (s.type === "M" || s.type === "Z" || s.type === "S") ? frame.direction(plane.normal) : null,
    inverts: s.type === "I",
  };
}

/// `turn`, `along`: 1 or -1, the senses of the turn and of the step.
function place(e: Elements, t: number, turn: number, along: number): Matrix4 {
  const matrix = new Matrix4().makeTranslation(-e.centre.x, -e.centre.y, -e.centre.z);
  if (e.normal) {
    const {x, y, z} = e.normal;
    const s = 2 * t;
    matrix.premultiply(new Matrix4().set(
      1 - s * x * x, -s * x * y, -s * x * z, 0,
      -s * x * y, 1 - s * y * y, -s * y * z, 0,
      -s * x * z, -s * y * z, 1 - s * z * z, 0,
      0, 0, 0, 1));
  }
  if (e.inverts) matrix.premultiply(new Matrix4().makeScale(1 - 2 * t, 1 - 2 * t, 1 - 2 * t));
  if (e.axis)
    matrix.premultiply(new Matrix4().makeRotationFromQuaternion(
      new Quaternion().setFromAxisAngle(e.axis, turn * e.angle * t)));
  const to = e.centre.clone().addScaledVector(e.step, along * t);
  return matrix.premultiply(new Matrix4().makeTranslation(to.x, to.y, to.z));
}

function distance(a: Matrix4, b: Matrix4): number {
  return Math.max(...a.elements.map((x, i) => Math.abs(x - b.elements[i])));
}

/// With how far its end is from the matrix of the report: rounding only.
export function motionOf(s: Symmetry, frame: Frame): {motion: Motion; error: number; sign: number} {
  const elements = elementsOf(s, frame);
  const end = frame.matrix(s.isometry.matrix);
  // The words do not say to which side a step along an axis goes (a left-handed thread): the matrix does.
  const senses = [[1, 1], [-1, 1], [1, -1], [-1, -1]];
  const errors = senses.map(([turn, along]) => distance(place(elements, 1, turn, along), end));
  const error = Math.min(...errors);
  const [turn, along] = senses[errors.indexOf(error)];
  return {motion: (t) => place(elements, t, turn, along), error, sign: turn};
}
