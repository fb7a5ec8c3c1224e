// The shaded mesh with wireframe and section plane, and triangles that stand out.
import * as THREE from 'three';
import { coarseCorners } from '../lod';
import type { Mesh } from '../mesh';
import type { Colour } from '../colours';

const LARGE = 150_000; // triangles above which a moving mesh is drawn coarsely

/** Flat shading from screen-space derivatives; cut open by a plane. */
const VERTEX = `
varying vec3 vView; varying vec3 vWorld;
void main() {
  vec4 world = modelMatrix * vec4(position, 1.0);
  vWorld = world.xyz;
  vec4 view = viewMatrix * world;
  vView = view.xyz;
  gl_Position = projectionMatrix * view;
}`;
const FRAGMENT = `
uniform vec3 tint; uniform vec4 section; uniform float flatness;
varying vec3 vView; varying vec3 vWorld;
void main() {
  if (dot(section.xyz, vWorld) > section.w) discard;
  vec3 n = normalize(cross(dFdx(vView), dFdy(vView)));
  n = faceforward(n, vView, n);
  float light = 0.42 + 0.4 * max(n.z, 0.0) + 0.25 * max(n.y, 0.0) + 0.12 * n.x;
  gl_FragColor = vec4(tint * mix(light, 1.0, flatness), 1.0);
}`;

function material(colour: Colour, flatness: number, section: THREE.Vector4): THREE.ShaderMaterial {
  return new THREE.ShaderMaterial({
    vertexShader: VERTEX,
    fragmentShader: FRAGMENT,
    side: THREE.DoubleSide,
    uniforms: { tint: { value: new THREE.Vector3(...colour).divideScalar(255) }, section: { value: section }, flatness: { value: flatness } },
  });
}

function edges(corners: Uint32Array): Uint32Array {
  const lines = new Uint32Array(2 * corners.length);
  for (let i = 0; i < corners.length; i += 3)
    for (let k = 0; k < 3; ++k) {
      lines[2 * (i + k)] = corners[i + k];
      lines[2 * (i + k) + 1] = corners[i + ((k + 1) % 3)];
    }
  return lines;
}

export class MeshLayer {
  readonly group = new THREE.Group();
  private readonly positions: THREE.BufferAttribute;
  private readonly section = new THREE.Vector4(0, 0, 0, 1);
  private readonly surface: THREE.Mesh;
  private readonly lines: THREE.LineSegments;
  private readonly coarse: THREE.Mesh | null = null;
  private corners: Uint32Array;
  private linesMade = false;
  private state = { mesh: true, wireframe: false, moving: false };

  constructor(private readonly mesh: Mesh) {
    this.positions = new THREE.BufferAttribute(mesh.positions, 3);
    this.corners = mesh.corners;
    const grey = material([186, 192, 200], 0, this.section);
    grey.polygonOffset = true;
    grey.polygonOffsetFactor = 1;
    grey.polygonOffsetUnits = 1;
    this.surface = this.add(new THREE.Mesh(this.geometry(mesh.corners), grey));
    this.lines = this.add(new THREE.LineSegments(this.geometry(new Uint32Array()), material([40, 44, 52], 1, this.section)));
    if (mesh.corners.length / 3 > LARGE) this.coarse = this.add(new THREE.Mesh(this.geometry(coarseCorners(mesh)), grey));
    this.apply();
  }

  private geometry(corners: Uint32Array): THREE.BufferGeometry {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', this.positions);
    geometry.setIndex(new THREE.BufferAttribute(corners, 1));
    return geometry;
  }

  private add<T extends THREE.Object3D>(object: T): T {
    object.frustumCulled = false;
    this.group.add(object);
    return object;
  }

  /** Only these triangles; null: all. */
  setTriangles(triangles: ArrayLike<number> | null): void {
    if (triangles === null) this.corners = this.mesh.corners;
    else {
      this.corners = new Uint32Array(3 * triangles.length);
      for (let i = 0; i < triangles.length; ++i)
        for (let k = 0; k < 3; ++k) this.corners[3 * i + k] = this.mesh.corners[3 * triangles[i] + k];
    }
    this.surface.geometry.setIndex(new THREE.BufferAttribute(this.corners, 1));
    this.linesMade = false;
    this.apply();
  }

  show(state: Partial<typeof this.state>): void {
    Object.assign(this.state, state);
    this.apply();
  }

  private apply(): void {
    const { mesh, wireframe, moving } = this.state;
    const coarse = moving && this.coarse !== null && this.corners === this.mesh.corners;
    this.surface.visible = mesh && !coarse;
    if (this.coarse) this.coarse.visible = mesh && coarse;
    this.lines.visible = wireframe && !coarse;
    if (!wireframe || this.linesMade) return;
    this.lines.geometry.setIndex(new THREE.BufferAttribute(edges(this.corners), 1));
    this.linesMade = true;
  }

  /** Cuts away what lies beyond `share` of the scene along an axis; none for a negative axis. */
  setSection(axis: number, share: number): void {
    const normal = new THREE.Vector3();
    const { lo, hi } = this.mesh.box;
    let offset = 1;
    if (axis >= 0) {
      normal.setComponent(axis, 1);
      offset = lo[axis] + (hi[axis] - lo[axis]) * share;
    }
    this.section.set(normal.x, normal.y, normal.z, offset);
  }

  /** Triangles in one colour, over the others. */
  highlight(triangles: number[], colour: Colour): THREE.Mesh {
    const corners = new Uint32Array(3 * triangles.length);
    triangles.forEach((triangle, i) => corners.set(this.mesh.corners.subarray(3 * triangle, 3 * triangle + 3), 3 * i));
    const result = new THREE.Mesh(this.geometry(corners), material(colour, 0.75, this.section));
    result.frustumCulled = false;
    result.renderOrder = 1;
    return result;
  }
}
