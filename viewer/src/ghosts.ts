// What would fill the empty slots: what stands at the end of a cycle, carried on by the isometry.
import {Matrix4, type Vector3} from "three";
import type {Frame, Symmetry} from "./report";

export interface Ghost {
  point: number; // whose entity it looks like
  matrix: Matrix4; // from there to the slot
}

const kNear = 1e-3; // of the model; slots are placed by fits, the deviation of which adds to it

/// `hasShape`: whether the entity of a point can be drawn. `others`: the slots that nothing drawn fills.
export function ghostsOf(
  s: Symmetry, frame: Frame, positions: Vector3[], hasShape: (point: number) => boolean): {ghosts: Ghost[]; others: Vector3[]} {
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
  return {ghosts, others: slots};
}
