// Many boxes at once: one drawn cube, with places and colours of its own for each.
import * as THREE from 'three';
import type { Colour } from '../colours';

const EDGES = [0, 1, 2, 3, 4, 5, 6, 7, 0, 2, 1, 3, 4, 6, 5, 7, 0, 4, 1, 5, 2, 6, 3, 7];
const FACES = [0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5];
const VERTEX = `
attribute vec3 lo; attribute vec3 hi; attribute vec3 tint;
varying vec3 vTint; varying vec3 vView; varying vec3 vWorld;
void main() {
  vTint = tint;
  vWorld = mix(lo, hi, position);
  vec4 view = viewMatrix * vec4(vWorld, 1.0);
  vView = view.xyz;
  gl_Position = projectionMatrix * view;
}`;
const FRAGMENT = `
uniform float opacity; uniform float solid;
varying vec3 vTint; varying vec3 vView; varying vec3 vWorld;
void main() {
  float light = 1.0;
  if (solid > 0.5) light = 0.6 + 0.4 * abs(normalize(cross(dFdx(vView), dFdy(vView))).z);
  gl_FragColor = vec4(vTint * light, opacity);
}`;

export interface BoxStyle {
  filled: boolean;
  opacity: number;
  /** Drawn over everything. */
  onTop?: boolean;
}

export interface BoxList {
  count: number;
  /** lo and hi of box i. */
  box: (i: number) => ArrayLike<number>;
  colour: (i: number) => Colour;
}

const cube = new THREE.BufferAttribute(new Float32Array(Array.from({ length: 8 }, (_, i) => [i & 1, (i >> 1) & 1, i >> 2]).flat()), 3);

export function boxes(list: BoxList, style: BoxStyle): THREE.Mesh | THREE.LineSegments {
  const geometry = new THREE.InstancedBufferGeometry();
  geometry.setAttribute('position', cube);
  geometry.setIndex(style.filled ? FACES : EDGES);
  geometry.instanceCount = list.count;
  const lo = new Float32Array(3 * list.count);
  const hi = new Float32Array(3 * list.count);
  const tint = new Uint8Array(3 * list.count);
  for (let i = 0; i < list.count; ++i) {
    const box = list.box(i);
    for (let axis = 0; axis < 3; ++axis) {
      lo[3 * i + axis] = box[axis];
      hi[3 * i + axis] = box[axis + 3];
    }
    tint.set(list.colour(i), 3 * i);
  }
  geometry.setAttribute('lo', new THREE.InstancedBufferAttribute(lo, 3));
  geometry.setAttribute('hi', new THREE.InstancedBufferAttribute(hi, 3));
  geometry.setAttribute('tint', new THREE.InstancedBufferAttribute(tint, 3, true));
  const material = new THREE.ShaderMaterial({
    vertexShader: VERTEX,
    fragmentShader: FRAGMENT,
    side: THREE.DoubleSide,
    transparent: style.opacity < 1 || style.onTop === true,
    depthWrite: style.opacity >= 1 && style.onTop !== true,
    depthTest: style.onTop !== true,
    uniforms: { opacity: { value: style.opacity }, solid: { value: style.filled ? 1 : 0 } },
  });
  const result = style.filled ? new THREE.Mesh(geometry, material) : new THREE.LineSegments(geometry, material);
  result.frustumCulled = false;
  result.renderOrder = style.onTop ? 3 : 2;
  return result;
}

/** Fewer of them while the camera moves; the list must begin with the largest. */
export function limitBoxes(object: THREE.Object3D, count: number, most: number): void {
  if (object instanceof THREE.Mesh || object instanceof THREE.LineSegments)
    (object.geometry as THREE.InstancedBufferGeometry).instanceCount = Math.min(count, most);
}
