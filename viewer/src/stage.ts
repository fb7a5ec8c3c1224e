// The canvas: one scene, one or two panes side by side under the same camera, drawn when something changed.
import * as THREE from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import type { Area } from './area';
import { begin, end } from './busy';
import { center, diagonal, type Box, type Vec } from './vec';

THREE.ColorManagement.enabled = false;
const FIELD_OF_VIEW = 45;
const UPS: Vec[] = [
  [1, 0, 0],
  [0, 1, 0],
  [0, 0, 1],
];

/** Narrow pictures show as much from side to side as square ones. */
function verticalField(aspect: number): number {
  return (2 * Math.atan(Math.tan((FIELD_OF_VIEW * Math.PI) / 360) / Math.min(1, aspect)) * 180) / Math.PI;
}

export function canUseWebGL(): boolean {
  try {
    return document.createElement('canvas').getContext('webgl2') !== null;
  } catch {
    return false;
  }
}

export class Stage {
  readonly renderer: THREE.WebGLRenderer;
  readonly scene = new THREE.Scene();
  /** What each pane alone shows. */
  readonly panes = [new THREE.Group(), new THREE.Group()];
  private camera: THREE.PerspectiveCamera | THREE.OrthographicCamera;
  private controls: OrbitControls;
  private paneCount = 1;
  private wanted = false;
  private resting = 0;
  private held = false;
  private area: Area | null = null;
  moving = false;
  /** Milliseconds that the last picture took. */
  lastFrame = 0;
  onMove: (moving: boolean) => void = () => undefined;
  onCamera: () => void = () => undefined;

  constructor(
    readonly host: HTMLElement,
    private readonly box: Box,
    private up: number,
  ) {
    this.renderer = new THREE.WebGLRenderer({ antialias: false, preserveDrawingBuffer: true });
    this.renderer.autoClear = false;
    this.renderer.outputColorSpace = THREE.LinearSRGBColorSpace; // colours are shown as they are written
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    host.append(this.renderer.domElement);
    this.scene.add(...this.panes);
    this.camera = this.freeCamera();
    this.controls = this.makeControls(center(box));
    new ResizeObserver(() => this.resize()).observe(host);
    this.resize();
  }

  get canvas(): HTMLCanvasElement {
    return this.renderer.domElement;
  }

  get current(): THREE.PerspectiveCamera | THREE.OrthographicCamera {
    return this.camera;
  }

  private freeCamera(): THREE.PerspectiveCamera {
    const size = diagonal(this.box) || 1;
    return new THREE.PerspectiveCamera(FIELD_OF_VIEW, 1, size * 1e-3, size * 50);
  }

  private makeControls(target: Vec): OrbitControls {
    const controls = new OrbitControls(this.camera, this.canvas);
    controls.target.set(...target);
    controls.enableDamping = false;
    controls.zoomToCursor = true;
    controls.addEventListener('start', () => (this.held = true));
    controls.addEventListener('end', () => {
      this.held = false;
      this.restSoon();
    });
    controls.addEventListener('change', () => {
      this.setMoving(true);
      this.restSoon();
      this.requestDraw();
      this.onCamera();
    });
    return controls;
  }

  /** Nothing is drawn in full while the pointer holds the scene. */
  private restSoon(): void {
    clearTimeout(this.resting);
    if (!this.held) this.resting = setTimeout(() => this.setMoving(false), 250) as unknown as number;
  }

  private setMoving(moving: boolean): void {
    if (this.moving === moving) return;
    this.moving = moving;
    if (moving) begin();
    else setTimeout(end);
    this.onMove(moving);
    this.requestDraw();
  }

  private use(camera: THREE.PerspectiveCamera | THREE.OrthographicCamera, target: Vec): void {
    this.controls.dispose();
    this.camera = camera;
    this.controls = this.makeControls(target);
    camera.lookAt(...target);
    this.resize();
    this.controls.update();
    this.onCamera();
  }

  /** All of the scene, from a corner above. */
  fit(box: Box = this.box): void {
    this.area = null;
    const middle = center(box);
    const size = diagonal(box) || 1;
    const up = new THREE.Vector3(...UPS[this.up]);
    const aside = new THREE.Vector3(...UPS[(this.up + 1) % 3]).addScaledVector(new THREE.Vector3(...UPS[(this.up + 2) % 3]), 0.7);
    const from = aside.addScaledVector(up, 0.8).normalize().multiplyScalar(size * 1.25);
    const camera = this.freeCamera();
    camera.up.copy(up);
    camera.position.set(...middle).add(from);
    this.use(camera, middle);
  }

  setUp(axis: number): void {
    this.up = axis;
    this.fit();
  }

  /** Looks as the area's rays do: orthographic for parallel ones, else from their point. */
  seeFrom(area: Area): void {
    this.area = area;
    const target = area.origin.map((x, i) => x + area.forward[i] * (area.near + area.far) * 0.5) as Vec;
    const size = diagonal(this.box) || 1;
    const camera =
      area.kind === 'plane'
        ? new THREE.OrthographicCamera(-1, 1, 1, -1, -size, area.far + size)
        : new THREE.PerspectiveCamera(60, 1, Math.max(area.near, size * 1e-5), area.far + size);
    camera.up.set(...area.up);
    camera.position.set(...area.origin);
    this.use(camera, target);
  }

  /** Position, target and zoom. */
  cameraNumbers(): number[] {
    return [...this.camera.position.toArray(), ...this.controls.target.toArray(), this.camera.zoom];
  }

  restore(numbers: number[]): void {
    if (numbers.length !== 7) return;
    this.camera.zoom = numbers[6] > 0 ? numbers[6] : 1;
    this.camera.updateProjectionMatrix();
    this.camera.position.set(numbers[0], numbers[1], numbers[2]);
    this.controls.target.set(numbers[3], numbers[4], numbers[5]);
    this.controls.update();
    this.requestDraw();
  }

  setPanes(count: number): void {
    this.paneCount = count;
    this.resize();
  }

  private resize(): void {
    const { clientWidth, clientHeight } = this.host;
    if (clientWidth === 0 || clientHeight === 0) return;
    this.renderer.setSize(clientWidth, clientHeight);
    const aspect = clientWidth / this.paneCount / clientHeight;
    if (this.camera instanceof THREE.PerspectiveCamera) {
      this.camera.aspect = aspect;
      this.camera.fov = verticalField(aspect);
      if (this.area) {
        const half = Math.max(this.area.half[1], this.area.half[0] / aspect);
        this.camera.fov = Math.min(170, (2 * Math.atan(half) * 180) / Math.PI);
      }
    } else if (this.area) {
      const half = Math.max(this.area.half[1], this.area.half[0] / aspect);
      this.camera.left = -half * aspect;
      this.camera.right = half * aspect;
      this.camera.top = half;
      this.camera.bottom = -half;
    }
    this.camera.updateProjectionMatrix();
    this.requestDraw();
  }

  requestDraw(): void {
    if (this.wanted) return;
    this.wanted = true;
    begin();
    requestAnimationFrame(() => {
      this.wanted = false;
      this.draw();
      end();
    });
  }

  draw(): void {
    const began = performance.now();
    const size = this.renderer.getSize(new THREE.Vector2());
    const background = getComputedStyle(document.documentElement).getPropertyValue('--stage').trim() || '#202428';
    this.renderer.setClearColor(new THREE.Color(background));
    const width = size.x / this.paneCount;
    this.renderer.setScissorTest(true);
    for (let pane = 0; pane < this.paneCount; ++pane) {
      this.panes.forEach((group, i) => (group.visible = i === pane));
      this.renderer.setViewport(pane * width, 0, width, size.y);
      this.renderer.setScissor(pane * width, 0, width, size.y);
      this.renderer.clear();
      this.renderer.render(this.scene, this.camera);
    }
    this.lastFrame = performance.now() - began;
    this.canvas.dataset.frames = String(Number(this.canvas.dataset.frames ?? 0) + 1);
  }

  /** The pane below a place of the page, and the ray through it. */
  rayAt(x: number, y: number): { pane: number; origin: Vec; direction: Vec } {
    const box = this.canvas.getBoundingClientRect();
    const width = box.width / this.paneCount;
    const pane = Math.min(Math.max(Math.floor((x - box.left) / width), 0), this.paneCount - 1);
    const at = new THREE.Vector2((2 * (x - box.left - pane * width)) / width - 1, 1 - (2 * (y - box.top)) / box.height);
    const caster = new THREE.Raycaster();
    caster.setFromCamera(at, this.camera);
    return { pane, origin: caster.ray.origin.toArray(), direction: caster.ray.direction.toArray() };
  }

  /** Where a point of the scene is on the page, in the pane `pane`; null behind the camera. */
  project(p: Vec, pane: number): [number, number] | null {
    const v = new THREE.Vector3(...p).project(this.camera);
    if (v.z > 1 || !Number.isFinite(v.x)) return null;
    const box = this.canvas.getBoundingClientRect();
    const width = box.width / this.paneCount;
    return [box.left + (pane + (v.x + 1) / 2) * width, box.top + ((1 - v.y) / 2) * box.height];
  }

  picture(): Promise<Blob | null> {
    this.draw();
    return new Promise((resolve) => this.canvas.toBlob(resolve, 'image/png'));
  }

  /** The camera's view as an area of rays through a point (the middle of an orthographic camera's window counts too). */
  viewArea(): Area {
    this.camera.updateMatrixWorld();
    const e = this.camera.matrixWorld.elements;
    const [right, up, back] = [0, 4, 8].map((i) => [e[i], e[i + 1], e[i + 2]] as Vec);
    const position = this.camera.position.toArray();
    const shared = {
      name: 'this view',
      right: right.map((x) => -x) as Vec,
      up,
      forward: back.map((x) => -x) as Vec,
      origin: position as Vec,
      tolerance: 0.01,
      slack: Infinity,
      planes: [],
      corners: [],
      far: diagonal(this.box) * 50,
    };
    if (this.camera instanceof THREE.PerspectiveCamera) {
      const half = Math.tan((this.camera.fov * Math.PI) / 360);
      return { ...shared, kind: 'point', half: [half * this.camera.aspect, half], near: this.camera.near };
    }
    const zoom = this.camera.zoom;
    return { ...shared, kind: 'plane', half: [this.camera.right / zoom, this.camera.top / zoom], near: 0 };
  }
}
