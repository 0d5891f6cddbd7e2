// Lines of a width in pixels, coloured by segment; very many are one pixel wide, which every graphics card does fast.
import {BufferAttribute, BufferGeometry, Color, LineBasicMaterial, LineSegments, type Vector3} from "three";
import {LineMaterial} from "three/examples/jsm/lines/LineMaterial.js";
import {LineSegments2} from "three/examples/jsm/lines/LineSegments2.js";
import {LineSegmentsGeometry} from "three/examples/jsm/lines/LineSegmentsGeometry.js";

const kManySegments = 12000;

export class LineSet {
  private readonly positions: number[] = [];
  private readonly colours: number[] = [];

  add(a: Vector3, b: Vector3, colour: Color): void {
    this.positions.push(a.x, a.y, a.z, b.x, b.y, b.z);
    this.colours.push(colour.r, colour.g, colour.b, colour.r, colour.g, colour.b);
  }

  path(points: Vector3[], closed: boolean, colour: Color): void {
    for (let i = 1; i < points.length; ++i) this.add(points[i - 1], points[i], colour);
    if (closed && points.length > 2) this.add(points[points.length - 1], points[0], colour);
  }

  make(width: number, opacity: number, through: boolean, dashed = 0): LineSegments2 | LineSegments | null {
    if (this.positions.length === 0) return null;
    if (this.positions.length > 6 * kManySegments) return this.makeThin(opacity, through);
    const geometry = new LineSegmentsGeometry();
    geometry.setPositions(this.positions);
    geometry.setColors(this.colours);
    const material = new LineMaterial({
      linewidth: width, vertexColors: true, transparent: true, opacity, depthTest: !through, depthWrite: false,
      dashed: dashed > 0, dashSize: dashed, gapSize: dashed * 0.6,
    });
    const lines = new LineSegments2(geometry, material);
    if (dashed > 0) lines.computeLineDistances();
    lines.frustumCulled = false;
    return lines;
  }

  private makeThin(opacity: number, through: boolean): LineSegments {
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(new Float32Array(this.positions), 3));
    geometry.setAttribute("color", new BufferAttribute(new Float32Array(this.colours), 3));
    return new LineSegments(geometry, new LineBasicMaterial({vertexColors: true, transparent: true, opacity, depthTest: !through}));
  }
}
