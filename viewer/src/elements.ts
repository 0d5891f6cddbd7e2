// What a symmetry turns about, reflects in or moves along, drawn.
import {
  BufferGeometry, Color, ConeGeometry, DoubleSide, Float32BufferAttribute, Group, Mesh, MeshBasicMaterial, Quaternion,
  SphereGeometry, Vector3,
} from "three";
import {LineSet} from "./lines";
import {type Frame, moves, type Symmetry, turns} from "./report";

const kReach = 1.18; // beyond the model, which lies in a ball of radius 1

function twoNormalTo(n: Vector3): [Vector3, Vector3] {
  const other = Math.abs(n.z) < 0.9 ? new Vector3(0, 0, 1) : new Vector3(1, 0, 0);
  const u = other.cross(n).normalize();
  return [u, n.clone().cross(u)];
}

function arrowHead(at: Vector3, along: Vector3, colour: Color, size = 0.05): Mesh {
  const head = new Mesh(new ConeGeometry(size * 0.45, size, 20), new MeshBasicMaterial({color: colour, depthTest: false, transparent: true}));
  head.position.copy(at);
  head.quaternion.copy(new Quaternion().setFromUnitVectors(new Vector3(0, 1, 0), along.clone().normalize()));
  return head;
}

function quad(corners: Vector3[], colour: Color): Mesh {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new Float32BufferAttribute(corners.flatMap((c) => c.toArray()), 3));
  geometry.setIndex([0, 1, 2, 0, 2, 3]);
  return new Mesh(geometry, new MeshBasicMaterial(
    {color: colour, transparent: true, opacity: 0.13, side: DoubleSide, depthWrite: false}));
}

/// The foot of 0 on the line or plane, so that what is drawn lies about the model.
function footOnLine(p: Vector3, d: Vector3): Vector3 {
  return p.clone().addScaledVector(d, -p.dot(d));
}

/// How far the outline reaches along a direction, and a margin.
function extent(outline: Vector3[], along: Vector3): [number, number] {
  let low = 0;
  let high = 0;
  for (const p of outline) {
    low = Math.min(low, p.dot(along));
    high = Math.max(high, p.dot(along));
  }
  return [low - 0.08, high + 0.08];
}

export function drawElements(s: Symmetry, frame: Frame, colour: Color, sign: number, flat: boolean, outline: Vector3[]): Group {
  const group = new Group();
  const {axis, plane, center, angle_deg, step} = s.isometry;
  const solid = new LineSet();
  const dashed = new LineSet();

  if (plane) {
    const n = frame.direction(plane.normal).normalize();
    const foot = n.clone().multiplyScalar(frame.point(plane.point).dot(n));
    if (flat) {
      const along = new Vector3(-n.y, n.x, 0);
      dashed.add(foot.clone().addScaledVector(along, -kReach), foot.clone().addScaledVector(along, kReach), colour);
    } else {
      const [u, v] = twoNormalTo(n);
      const [left, right] = extent(outline, u);
      const [bottom, top] = extent(outline, v);
      const corners = [[left, bottom], [right, bottom], [right, top], [left, top]].map(([a, b]) =>
        foot.clone().addScaledVector(u, a).addScaledVector(v, b));
      group.add(quad(corners, colour));
      solid.path(corners, true, colour);
    }
  }
  if (axis && turns(s)) {
    const d = frame.direction(axis.direction).normalize();
    const foot = footOnLine(frame.point(axis.point), d);
    dashed.add(foot.clone().addScaledVector(d, -kReach), foot.clone().addScaledVector(d, kReach), colour);
    group.add(arrowHead(foot.clone().addScaledVector(d, kReach), d, colour));
  }
  if (turns(s) && (axis || center)) {
    const d = axis ? frame.direction(axis.direction).normalize() : new Vector3(0, 0, 1);
    const middle = center ? frame.point(center) : footOnLine(frame.point(axis!.point), d);
    if (axis && !flat && !center) middle.addScaledVector(d, kReach * 0.86);
    drawArc(middle, d, (sign * angle_deg * Math.PI) / 180, flat ? 0.16 : 0.2, solid, group, colour);
  }
  if (moves(s) && axis) {
    const d = frame.direction(axis.direction).normalize();
    const p = s.cycles.length > 0 && s.type === "T" ? new Vector3() : footOnLine(frame.point(axis.point), d);
    const tip = p.clone().addScaledVector(d, step * frame.scale);
    solid.add(p, tip, colour);
    group.add(arrowHead(tip, d, colour, 0.06));
    const far = 0.9;
    if (s.type !== "W") dashed.add(p.clone().addScaledVector(d, -far), p.clone().addScaledVector(d, far), colour);
  }
  if (center && (s.type === "I" || s.type === "S" || flat)) {
    const ball = new Mesh(new SphereGeometry(0.018, 20, 14), new MeshBasicMaterial({color: colour, depthTest: false, transparent: true}));
    ball.position.copy(frame.point(center));
    group.add(ball);
  }
  for (const lines of [solid.make(2.5, 1, true), dashed.make(1.8, 0.9, true, 0.035)]) if (lines) group.add(lines);
  group.renderOrder = 5;
  return group;
}

function drawArc(middle: Vector3, d: Vector3, angle: number, radius: number, lines: LineSet, group: Group, colour: Color): void {
  const [u, v] = twoNormalTo(d);
  const at = (a: number) =>
    middle.clone().addScaledVector(u, radius * Math.cos(a)).addScaledVector(v, radius * Math.sin(a));
  const count = Math.max(6, Math.ceil(Math.abs(angle) * 14));
  lines.path(Array.from({length: count + 1}, (_, i) => at((angle * i) / count)), false, colour);
  const end = at(angle);
  group.add(arrowHead(end, end.clone().sub(at(angle * (1 - 1 / count))), colour, 0.045));
}
