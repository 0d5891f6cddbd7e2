// What would fill the empty slots: what stands at the end of a cycle, carried on by the isometry.
import {Matrix4, type Vector3} from "three";
import type {Frame, Symmetry} from "./report";

export interface Ghost {
  point: number; // whose entity it looks like
  matrix: Matrix4; // from there to the slot
}

const kNear = 1e-3; // of the model; slots are placed by fits, the deviation of which adds to it

/// `hasShape`: whether the entity of a point can be drawn; `cornersOf`: ends of the edges that are drawn for it.
/// `others`: the slots that nothing drawn fills, and where no corner of it stands.
export function ghostsOf(
  s: Symmetry, frame: Frame, positions: Vector3[], hasShape: (point: number) => boolean,
  cornersOf: (point: number) => Vector3[]): {ghosts: Ghost[]; others: Vector3[]} {
  const step = frame.matrix(s.isometry.matrix);
  const near = kNear + 4 * s.deviation.max * frame.scale;
  const slots = s.missing.map((slot) => frame.point(slot.position));
  const take = (place: Vector3): boolean => {
    const at = slots.findIndex((slot) => slot.distanceTo(place) < near);
    if (at >= 0) slots.splice(at, 1);
    return at >= 0;
  };
  const ghosts: Ghost[] = [];
  for (const {points, closed} of s.cycles) {
    const point = points[points.length - 1];
    if (closed || slots.length === 0 || !hasShape(point)) continue;
    const matrix = step.clone();
    while (take(positions[point].clone().applyMatrix4(matrix))) {
      ghosts.push({point, matrix: matrix.clone()});
      matrix.premultiply(step);
    }
  }
  for (const {point, matrix} of slots.length > 0 ? ghosts : [])
    for (const corner of cornersOf(point)) take(corner.applyMatrix4(matrix));
  return {ghosts, others: slots};
}
