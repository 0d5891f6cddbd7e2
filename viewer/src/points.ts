// Points as marks of a fixed size on the screen: discs for points, rings for fixed ones, broken rings for empty slots.
import {BufferAttribute, BufferGeometry, Color, Points, ShaderMaterial, type Vector3} from "three";

export enum Mark { disc, ring, broken }

const kVertex = `
attribute vec3 colour;
attribute float mark;
uniform float size;
uniform float scale;
varying vec3 vColour;
varying float vMark;
void main() {
  vColour = colour;
  vMark = mark;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  gl_PointSize = size * scale * (mark > 0.5 ? 1.9 : 1.0);
}`;

const kFragment = `
uniform float opacity;
uniform vec3 rim;
uniform float rimStart;
varying vec3 vColour;
varying float vMark;
void main() {
  vec2 p = gl_PointCoord * 2.0 - 1.0;
  float r = length(p);
  if (r > 1.0) discard;
  if (vMark > 0.5 && r < 0.62) discard;
  if (vMark > 1.5 && fract(atan(p.y, p.x) * 0.9549297) > 0.62) discard;
  gl_FragColor = vec4(vMark < 0.5 && r > rimStart ? rim : vColour, opacity);
  #include <colorspace_fragment>
}`;

interface Style {
  size: number;
  opacity: number;
  rim: number;
  through: boolean; // also where the model hides them
  scale: {value: number}; // of the size; may change later
}

export function makePoints(positions: Vector3[], colours: Color[], marks: Mark[], style: Style): Points {
  const geometry = new BufferGeometry();
  const flat = (items: {toArray(): number[]}[]) => new Float32Array(items.flatMap((item) => item.toArray()));
  geometry.setAttribute("position", new BufferAttribute(flat(positions), 3));
  geometry.setAttribute("colour", new BufferAttribute(flat(colours), 3));
  geometry.setAttribute("mark", new BufferAttribute(new Float32Array(marks), 1));
  const material = new ShaderMaterial({
    vertexShader: kVertex,
    fragmentShader: kFragment,
    uniforms: {
      size: {value: style.size}, scale: style.scale, opacity: {value: style.opacity}, rim: {value: new Color(style.rim)},
      rimStart: {value: style.size < 7 ? 2 : 0.8}, // small ones have none
    },
    transparent: true,
    depthTest: !style.through,
    depthWrite: false,
  });
  const points = new Points(geometry, material);
  points.frustumCulled = false;
  return points;
}
