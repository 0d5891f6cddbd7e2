// The picture: model, points, the chosen symmetry on it, its motion. Draws only when something has changed.
import {
  AmbientLight, BufferAttribute, BufferGeometry, Color, DirectionalLight, DoubleSide, Group, LineBasicMaterial,
  LineSegments, Matrix4, Mesh, MeshBasicMaterial, MeshLambertMaterial, type Object3D, OrthographicCamera, Plane, type Points, Raycaster, Scene, Vector2,
  Vector3, WebGLRenderer,
} from "three";
import {OrbitControls} from "three/examples/jsm/controls/OrbitControls.js";
import {onNextFrame} from "./dom";
import {drawElements} from "./elements";
import {type Ghost, ghostsOf} from "./ghosts";
import {LineSet} from "./lines";
import {type Motion, motionOf} from "./motion";
import {kDark, kLight, orbitColour, type Theme} from "./palette";
import {makePoints, Mark} from "./points";
import {type Frame, frameOf, type Model, type Report, type Symmetry} from "./report";

const kPickRadius = 14; // pixels
const kManyPoints = 5000; // smooth edges would take too long
const kFullPoints = 520; // pixels of the canvas from which points have their full size
const kLeastPoints = 0.6; // of it

export class Stage {
  readonly frame: Frame;
  private readonly renderer: WebGLRenderer;
  private readonly scene = new Scene();
  private readonly camera = new OrthographicCamera(-1, 1, 1, -1, -20, 20);
  private readonly controls: OrbitControls;
  private readonly positions: Vector3[];
  private readonly surface: BufferGeometry;
  private readonly lines: BufferGeometry;
  private readonly pointOf = new Map<string, number>(); // "face 12" -> point
  private readonly shapes = new Set<string>(); // "face 12", "edge 3": what the model has
  private readonly linesOf = new Map<string, number[]>(); // "edge 3" -> lines
  private readonly base = new Group(); // model and points
  private readonly overlay = new Group(); // the chosen symmetry
  private readonly mover = new Group(); // what moves
  private readonly pick = new Group(); // the chosen point
  private theme: Theme = kLight;
  private shown: Symmetry | null = null;
  private picked: number | null = null;
  private motion: Motion | null = null;
  private readonly pointScale = {value: 1}; // from the sizes below to pixels of the canvas
  private readonly ask = onNextFrame(() => this.draw());
  onFrame: () => void = () => {};

  constructor(private readonly canvas: HTMLCanvasElement, private readonly report: Report, private readonly model: Model) {
    this.frame = frameOf(report, model);
    this.positions = report.points.map((p) => this.frame.point(p));
    this.surface = this.makeSurface();
    this.lines = this.makeLines();
    report.points.forEach((_, i) => {
      for (const name of this.names(i)) this.pointOf.set(name, i);
    });
    for (const id of model.faces) this.shapes.add(`face ${id}`);
    model.line_edges.forEach((id, line) => {
      const name = `edge ${id}`;
      this.shapes.add(name);
      this.linesOf.set(name, [...(this.linesOf.get(name) ?? []), line]);
    });
    this.renderer = new WebGLRenderer({canvas, antialias: report.points.length < kManyPoints});
    this.renderer.localClippingEnabled = true;
    if (!this.flat) this.camera.up.set(0, 0, 1); // before the controls, which take it once
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.zoomSpeed = 1.5;
    this.controls.enableRotate = !this.flat;
    this.controls.screenSpacePanning = true;
    this.controls.addEventListener("change", () => this.ask());
    this.mover.matrixAutoUpdate = false;
    const key = new DirectionalLight(0xffffff, 2.1);
    key.position.set(-0.6, 0.9, 1.6);
    this.camera.add(key, new AmbientLight(0xffffff, 1.25));
    this.scene.add(this.base, this.overlay, this.mover, this.pick, this.camera);
    this.home();
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement as Element);
    this.resize();
  }

  get flat(): boolean {
    return this.report.input.dimension === 2;
  }

  // The model --------------------------------------------------------------------------------------

  private makeSurface(): BufferGeometry {
    const geometry = new BufferGeometry();
    const scaled = this.model.positions.map((x) => x * this.frame.scale);
    geometry.setAttribute("position", new BufferAttribute(scaled, 3));
    geometry.setAttribute("normal", new BufferAttribute(this.model.normals, 3, true));
    geometry.setIndex(new BufferAttribute(this.model.triangles, 1));
    geometry.userData.shared = true;
    return geometry;
  }

  private linePoint(i: number): Vector3 {
    return new Vector3().fromArray(this.model.line_points, 3 * i).multiplyScalar(this.frame.scale);
  }

  private lineEnd(line: number): number {
    const {line_starts, line_points} = this.model;
    return line + 1 < line_starts.length ? line_starts[line + 1] : line_points.length / 3;
  }

  private makeLines(): BufferGeometry {
    const {line_starts, line_points} = this.model;
    const index: number[] = [];
    for (let line = 0; line < line_starts.length; ++line)
      for (let i = line_starts[line]; i + 1 < this.lineEnd(line); ++i) index.push(i, i + 1);
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(line_points.map((x) => x * this.frame.scale), 3));
    geometry.setIndex(index);
    geometry.userData.shared = true;
    return geometry;
  }

  private get hasModel(): boolean {
    return this.model.triangles.length > 0;
  }

  private surfaceMesh(colour: number | Color, opacity: number, planes: Plane[] = []): Mesh {
    return new Mesh(this.surface, new MeshLambertMaterial({
      color: colour, side: DoubleSide, transparent: opacity < 1, opacity, depthWrite: opacity === 1,
      polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 2, clippingPlanes: planes,
    }));
  }

  /// `size`: in pixels of a canvas that is not small. `through`: also where the model hides them.
  private points(positions: Vector3[], colours: Color[], marks: Mark[], size: number, opacity = 1, through = false): Points {
    return makePoints(positions, colours, marks, {size, opacity, through, rim: this.theme.background, scale: this.pointScale});
  }

  private edgeLines(colour: number, opacity: number): LineSegments {
    return new LineSegments(this.lines, new LineBasicMaterial({color: colour, transparent: true, opacity}));
  }

  /// The plane that parts the halves of a mirrored model, if the chosen symmetry has one.
  private halves(): {normal: Vector3; offset: number} | null {
    const plane = this.shown && (this.shown.type === "M" || this.shown.type === "Z") ? this.shown.isometry.plane : null;
    if (!plane) return null;
    const normal = this.frame.direction(plane.normal).normalize();
    return {normal, offset: this.frame.point(plane.point).dot(normal)};
  }

  private drawBase(): void {
    clear(this.base);
    const halves = this.halves();
    if (this.hasModel) {
      if (halves) {
        const {normal, offset} = halves;
        this.base.add(this.surfaceMesh(this.theme.halves[0], 1, [new Plane(normal.clone(), -offset)]));
        this.base.add(this.surfaceMesh(this.theme.halves[1], 1, [new Plane(normal.clone().negate(), offset)]));
      } else {
        this.base.add(this.surfaceMesh(this.theme.model, 1));
      }
    }
    if (this.model.line_starts.length > 0) this.base.add(this.edgeLines(this.theme.edge, this.shown ? 0.55 : 0.9));
    const plain = new Color(this.theme.point);
    const sides = this.theme.halves.map((c) => new Color(c).lerp(plain, 0.35));
    const colours = this.positions.map((p) =>
      halves && !this.hasModel ? sides[p.dot(halves.normal) >= halves.offset ? 0 : 1] : plain);
    const size = this.hasModel ? (this.shown ? 3 : 5) : this.positions.length > 3000 ? 5 : 8;
    const marks = this.positions.map(() => Mark.disc);
    this.base.add(this.points(this.positions, colours, marks, size));
  }

  /// The faces or edges that a point stands for: "face 12".
  private names(point: number): string[] {
    const entity = this.report.entities?.[point];
    return entity ? (entity.ids ?? [entity.id]).map((id) => `${entity.kind} ${id}`) : [];
  }

  // The chosen symmetry ----------------------------------------------------------------------------

  private get dark(): boolean {
    return this.theme === kDark;
  }

  /// Entities of the orbits: "face 12" -> colour.
  private colouredEntities(s: Symmetry): Map<string, Color> {
    const colours = new Map<string, Color>();
    s.cycles.forEach((cycle, c) => {
      for (const i of cycle.points) for (const name of this.names(i)) colours.set(name, orbitColour(c, this.dark));
    });
    return colours;
  }

  private colouredFaces(colours: Map<string, Color>): Mesh | null {
    const index: number[] = [];
    const shades: number[] = [];
    const {faces, triangles} = this.model;
    for (let t = 0; t < faces.length; ++t) {
      const colour = faces[t] > 0 ? colours.get(`face ${faces[t]}`) : undefined;
      if (!colour) continue;
      for (let k = 0; k < 3; ++k) {
        index.push(triangles[3 * t + k]);
        shades.push(colour.r, colour.g, colour.b);
      }
    }
    if (index.length === 0) return null;
    const geometry = new BufferGeometry();
    for (const name of ["position", "normal"]) {
      const from = this.surface.getAttribute(name);
      const values = new Float32Array(3 * index.length);
      index.forEach((v, i) => {
        for (let k = 0; k < 3; ++k) values[3 * i + k] = from.getComponent(v, k);
      });
      geometry.setAttribute(name, new BufferAttribute(values, 3));
    }
    geometry.setAttribute("color", new BufferAttribute(new Float32Array(shades), 3));
    return new Mesh(geometry, new MeshLambertMaterial({vertexColors: true, side: DoubleSide}));
  }

  /// Faces and edges as they would stand in the empty slots; seen through the model, as holes would be inside it.
  private drawGhosts(found: Ghost[]): void {
    const ghosts = new Map<string, Matrix4[]>();
    for (const {point, matrix} of found)
      for (const name of this.names(point)) ghosts.set(name, [...(ghosts.get(name) ?? []), matrix]);
    if (ghosts.size === 0) return;
    const colour = new Color(this.theme.element);
    const corners: number[] = [];
    const places = this.surface.getAttribute("position");
    const p = new Vector3();
    const {faces, triangles, line_edges, line_starts} = this.model;
    faces.forEach((id, t) => {
      for (const matrix of ghosts.get(`face ${id}`) ?? [])
        for (let k = 0; k < 3; ++k)
          corners.push(...p.fromBufferAttribute(places, triangles[3 * t + k]).applyMatrix4(matrix).toArray());
    });
    const edges = new LineSet();
    line_edges.forEach((id, line) => {
      for (const matrix of ghosts.get(`edge ${id}`) ?? [])
        for (let i = line_starts[line]; i + 1 < this.lineEnd(line); ++i)
          edges.add(this.linePoint(i).applyMatrix4(matrix), this.linePoint(i + 1).applyMatrix4(matrix), colour);
    });
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(new Float32Array(corners), 3));
    const material = new MeshBasicMaterial(
      {color: colour, transparent: true, opacity: 0.16, side: DoubleSide, depthTest: false, depthWrite: false});
    this.overlay.add(new Mesh(geometry, material));
    const lines = edges.make(1.8, 0.9, true);
    if (lines) this.overlay.add(lines);
  }

  private slots(s: Symmetry): {ghosts: Ghost[]; others: Vector3[]} {
    return ghostsOf(s, this.frame, this.positions, (point) => this.names(point).some((name) => this.shapes.has(name)),
      (point) => this.cornersOf(point));
  }

  /// Both ends of the edges of a point's entity.
  private cornersOf(point: number): Vector3[] {
    return this.names(point).flatMap((name) => this.linesOf.get(name) ?? []).flatMap((line) =>
      [this.linePoint(this.model.line_starts[line]), this.linePoint(this.lineEnd(line) - 1)]);
  }

  private drawOverlay(): void {
    clear(this.overlay);
    const s = this.shown;
    if (!s) return;
    const {ghosts, others} = this.slots(s);
    this.drawGhosts(ghosts);
    const colours = this.colouredEntities(s);
    const faces = this.colouredFaces(colours);
    if (faces) this.overlay.add(faces);
    const edges = new LineSet();
    this.model.line_edges.forEach((id, line) => {
      const colour = id > 0 ? colours.get(`edge ${id}`) : undefined;
      if (!colour) return;
      for (let i = this.model.line_starts[line]; i + 1 < this.lineEnd(line); ++i)
        edges.add(this.linePoint(i), this.linePoint(i + 1), colour);
    });
    const paths = new LineSet();
    const positions: Vector3[] = [];
    const shades: Color[] = [];
    const marks: Mark[] = [];
    const mark = (p: Vector3, colour: Color, kind: Mark) => {
      positions.push(p);
      shades.push(colour);
      marks.push(kind);
    };
    s.cycles.forEach((cycle, c) => {
      const colour = orbitColour(c, this.dark);
      const points = cycle.points.map((i) => this.positions[i]);
      paths.path(points, cycle.closed, colour);
      for (const p of points) mark(p, colour, Mark.disc);
    });
    const ink = new Color(this.theme.ink);
    for (const i of s.fixed_points) mark(this.positions[i], ink, Mark.ring);
    for (const slot of others) mark(slot, new Color(this.theme.element), Mark.broken);
    const many = positions.length;
    const size = many > 1000 ? 4.5 : many > 300 ? 6 : many > 100 ? 8 : 11;
    const thin = s.cycles.length > 60 ? 0.5 : 1; // hundreds of cycles would hide the model
    const layers = [
      edges.make(2.6, 1, false),
      this.hasModel ? paths.make(1.6 * thin, 0.4 * thin, true) : null, // seen through the model
      paths.make(2.4 * thin, 0.5 + 0.5 * thin, false),
      this.hasModel ? this.points(positions, shades, marks, size * 0.8, 0.45, true) : null,
      this.points(positions, shades, marks, size),
    ];
    for (const layer of layers) if (layer) this.overlay.add(layer);
    const {sign} = motionOf(s, this.frame);
    this.overlay.add(drawElements(s, this.frame, new Color(this.theme.element), sign, this.flat, this.outline()));
  }

  /// Points that say how far the model reaches.
  private outline(): Vector3[] {
    const outline = [...this.positions];
    const {positions} = this.model;
    const every = 3 * Math.ceil(positions.length / 3 / 5000);
    for (let i = 0; i < positions.length; i += every)
      outline.push(new Vector3().fromArray(positions, i).multiplyScalar(this.frame.scale));
    return outline;
  }

  private drawMover(): void {
    clear(this.mover);
    const s = this.shown;
    if (!s) return;
    if (this.hasModel) this.mover.add(this.surfaceMesh(this.theme.mover, 0.28), this.edgeLines(this.theme.mover, 0.9));
    const points = s.cycles.flatMap((cycle) => cycle.points).map((i) => this.positions[i]);
    const colour = new Color(this.theme.mover);
    const size = this.hasModel && points.length > 100 ? 2.5 : 7; // where many would hide what moves
    this.mover.add(this.points(points, points.map(() => colour), points.map(() => Mark.ring), size, 1, true));
  }

  private drawPick(): void {
    clear(this.pick);
    if (this.picked === null) return;
    this.pick.add(this.points([this.positions[this.picked]], [new Color(this.theme.ink)], [Mark.ring], 13, 1, true));
  }

  private drawAll(): void {
    this.drawBase();
    this.drawOverlay();
    this.drawMover();
    this.drawPick();
    this.ask();
  }

  // What others tell it ----------------------------------------------------------------------------

  setTheme(dark: boolean): void {
    this.theme = dark ? kDark : kLight;
    this.renderer.setClearColor(this.theme.background);
    this.drawAll();
  }

  show(s: Symmetry | null): void {
    this.shown = s;
    this.motion = s ? motionOf(s, this.frame).motion : null;
    this.drawAll();
    this.setTime(0);
  }

  markPoint(point: number | null): void {
    this.picked = point;
    this.drawPick();
    this.ask();
  }

  /// 0: the model as it is; 1: carried by the isometry.
  setTime(t: number): void {
    this.mover.visible = t > 0;
    this.mover.matrix.copy(this.motion ? this.motion(t) : new Matrix4());
    this.mover.matrixWorldNeedsUpdate = true;
    this.ask();
  }

  // The view ---------------------------------------------------------------------------------------

  home(): void {
    this.look(this.flat ? new Vector3(0, 0, 1) : new Vector3(0.62, -0.94, 0.72));
  }

  /// Along the axis or at the plane of the chosen symmetry.
  lookAlong(): void {
    const {axis, plane} = this.shown?.isometry ?? {axis: null, plane: null};
    if (this.flat || !(axis || plane)) return this.home();
    const moves = this.shown?.type === "T" || this.shown?.type === "Z";
    if (axis && !moves) return this.look(this.frame.direction(axis.direction));
    const normal = plane ? this.frame.direction(plane.normal) : this.frame.direction(axis!.direction);
    this.look(normal.cross(Math.abs(normal.z) < 0.9 ? new Vector3(0, 0, 1) : new Vector3(0, 1, 0)));
  }

  private look(from: Vector3): void {
    const direction = from.clone().normalize();
    this.controls.target.set(0, 0, 0);
    this.camera.position.copy(direction.multiplyScalar(4));
    this.camera.zoom = 1;
    this.camera.updateProjectionMatrix();
    this.controls.update();
    this.ask();
  }

  turn(radians: number): void {
    this.camera.position.applyAxisAngle(this.camera.up, radians);
    this.controls.update();
    this.ask();
  }

  private resize(): void {
    const box = this.canvas.parentElement as Element;
    const width = Math.max(1, box.clientWidth);
    const height = Math.max(1, box.clientHeight);
    const half = 1.14; // what lies in the ball of radius 1, and a margin
    const x = width > height ? (half * width) / height : half;
    const y = width > height ? half : (half * height) / width;
    Object.assign(this.camera, {left: -x, right: x, top: y, bottom: -y});
    this.camera.updateProjectionMatrix();
    this.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio));
    this.renderer.setSize(width, height);
    // On a small canvas points are smaller, so that the model is still seen.
    this.pointScale.value = this.renderer.getPixelRatio() * Math.min(1, Math.max(kLeastPoints, Math.min(width, height) / kFullPoints));
    this.ask();
  }

  draw(): void {
    this.renderer.render(this.scene, this.camera);
    this.onFrame();
  }

  // Picking ----------------------------------------------------------------------------------------

  /// Where a point is on the canvas, in CSS pixels.
  screen(point: number): {x: number; y: number} {
    const p = this.positions[point].clone().project(this.camera);
    return {x: ((p.x + 1) / 2) * this.canvas.clientWidth, y: ((1 - p.y) / 2) * this.canvas.clientHeight};
  }

  /// The point at a place of the canvas: the nearest one, or that of the face there.
  pointAt(x: number, y: number): number | null {
    this.camera.updateMatrixWorld();
    let best: number | null = null;
    let least = kPickRadius;
    const p = new Vector3();
    this.positions.forEach((position, i) => {
      p.copy(position).project(this.camera);
      const away = Math.hypot(
        ((p.x + 1) / 2) * this.canvas.clientWidth - x, ((1 - p.y) / 2) * this.canvas.clientHeight - y) + p.z * 0.5;
      if (away < least) {
        least = away;
        best = i;
      }
    });
    return best ?? this.pointOfFaceAt(x, y);
  }

  private pointOfFaceAt(x: number, y: number): number | null {
    if (!this.hasModel) return null;
    const ray = new Raycaster();
    ray.setFromCamera(new Vector2((x / this.canvas.clientWidth) * 2 - 1, 1 - (y / this.canvas.clientHeight) * 2), this.camera);
    const mesh = new Mesh(this.surface, new MeshLambertMaterial({side: DoubleSide}));
    const hit = ray.intersectObject(mesh)[0];
    return hit ? this.pointOf.get(`face ${this.model.faces[hit.faceIndex ?? 0]}`) ?? null : null;
  }

  // For tests --------------------------------------------------------------------------------------

  /// How many empty slots of the chosen symmetry are drawn as what would fill them, and how many as rings.
  emptySlots(): {ghosts: number; rings: number} {
    const {ghosts, others} = this.shown ? this.slots(this.shown) : {ghosts: [], others: []};
    return {ghosts: ghosts.length, rings: others.length};
  }

  /// The largest distance of the end of a motion from the matrix of the report, over all symmetries.
  motionError(): number {
    return this.report.symmetries.reduce((most, s) => Math.max(most, motionOf(s, this.frame).error), 0);
  }
}

/// Frees what it held on the graphics card; the shared geometry of the model is only used again.
function clear(group: Group): void {
  group.traverse((object: Object3D) => {
    const {material, geometry} = object as Partial<Mesh>;
    if (geometry && !geometry.userData.shared) geometry.dispose();
    for (const m of Array.isArray(material) ? material : material ? [material] : []) m.dispose();
  });
  group.clear();
}
