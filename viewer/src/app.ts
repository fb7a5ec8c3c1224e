// What the page holds and does; panels and keys only ask and tell it.
import type { Area } from './area';
import { begin, end } from './busy';
import { inkColour, ROLE_COLOURS, type Colour } from './colours';
import { castRays, measureRays, type RayStats } from './cost';
import type { ViewData } from './data';
import { boxes, limitBoxes } from './layers/box_layer';
import { areaLines, segments, type Segment } from './layers/line_layer';
import { MeshLayer } from './layers/mesh_layer';
import { topLevelCells } from './layers/top_layer';
import type { Mesh } from './mesh';
import { nodeColours, shownNodes, type NodeColours, type ShownNodes } from './shown_nodes';
import { Stage } from './stage';
import type { Key, State, Store } from './state';
import type { TopLevel } from './top_level';
import { boxOf, isLeaf, loadTree, siblingOf, trianglesBelow, type Tree } from './tree';
import { diagonal, type Ray, type Vec } from './vec';
import { search } from './walk';
import * as THREE from 'three';

const MOST_MOVING = 4000; // boxes while the camera moves

export class Pane {
  readonly boxGroup = new THREE.Group();
  readonly nodeGroup = new THREE.Group();
  readonly visitGroup = new THREE.Group();
  shown: ShownNodes = { nodes: new Uint32Array(), total: 0 };
  colours: NodeColours | null = null;
  tree: Tree | null = null;
  stats: RayStats | null = null;
  visits: Uint32Array | null = null;

  constructor(group: THREE.Group) {
    group.add(this.boxGroup, this.nodeGroup, this.visitGroup);
  }
}

function clear(group: THREE.Group): void {
  for (const child of [...group.children]) {
    group.remove(child);
    if (child instanceof THREE.Mesh || child instanceof THREE.LineSegments) {
      const geometry = child.geometry as THREE.BufferGeometry;
      geometry.deleteAttribute('position'); // shared ones live on
      geometry.dispose();
    }
  }
}

export class App {
  readonly panes: Pane[];
  readonly meshLayer: MeshLayer;
  rays: Ray[] = [];
  ownRays: Ray[] | null = null;
  private readonly trees = new Map<number, Promise<Tree>>();
  private readonly areaGroup = new THREE.Group();
  private readonly topGroup = new THREE.Group();
  private readonly rayGroup = new THREE.Group();
  private readonly listeners: (() => void)[] = [];

  constructor(
    readonly data: ViewData,
    readonly mesh: Mesh,
    readonly top: TopLevel,
    readonly store: Store,
    readonly stage: Stage,
  ) {
    this.meshLayer = new MeshLayer(mesh);
    this.panes = stage.panes.map((group) => new Pane(group));
    stage.scene.add(this.meshLayer.group, this.areaGroup, this.topGroup, this.rayGroup);
    stage.onMove = (moving) => this.whileMoving(moving);
    stage.onCamera = () => store.set({ camera: stage.cameraNumbers() });
    store.on((changed) => void this.apply(changed));
  }

  get state(): State {
    return this.store.state;
  }

  /** Told after everything has followed the state. */
  onChange(listener: () => void): void {
    this.listeners.push(listener);
  }

  private tell(): void {
    for (const listener of this.listeners) listener();
  }

  tree(index: number): Promise<Tree> {
    let tree = this.trees.get(index);
    if (!tree) this.trees.set(index, (tree = loadTree(this.data.trees[index], this.mesh)));
    return tree;
  }

  areaOf(pane: number): Area | null {
    const info = this.panes[pane].tree?.info ?? this.data.trees[pane === 0 ? this.state.tree : this.state.other];
    return info && info.area >= 0 ? this.data.areas[info.area] : null;
  }

  async start(): Promise<void> {
    const { light, camera } = this.state;
    if (light >= 0 && this.data.areas[light]) this.stage.seeFrom(this.data.areas[light]);
    else if (this.state.up !== 1) this.stage.setUp(this.state.up);
    else this.stage.fit();
    this.stage.restore(camera);
    await this.apply(new Set(Object.keys(this.state) as Key[]));
    this.whileMoving(true); // what a drag needs is there from the beginning
    this.stage.draw();
    this.whileMoving(false);
  }

  /** Makes everything that depends on what changed anew. */
  private async apply(changed: Set<Key>): Promise<void> {
    begin();
    try {
      await this.follow(changed);
    } finally {
      end();
    }
  }

  private async follow(changed: Set<Key>): Promise<void> {
    const any = (...keys: Key[]): boolean => keys.some((key) => changed.has(key));
    if (any('tree', 'other', 'compare')) await this.loadPanes();
    if (any('mesh', 'wireframe', 'members', 'tree')) this.applyMesh();
    if (any('section', 'sectionAt')) this.meshLayer.setSection(this.state.section - 1, this.state.sectionAt / 100);
    if (any('hidden')) this.applyAreas();
    if (any('top', 'cell', 'hidden')) this.applyTop();
    if (any('rays', 'seed', 'cast', 'tree', 'other', 'compare')) this.applyRays();
    if (any('tree', 'other', 'compare', 'show', 'level', 'colour', 'filled') || (any('rays', 'seed', 'cast') && this.state.colour === 'visits'))
      this.applyBoxes();
    if (any('node', 'otherNode', 'tree', 'other', 'compare', 'theme')) this.applyNodes();
    if (!(changed.size === 1 && changed.has('camera'))) this.tell();
    this.stage.requestDraw();
  }

  private async loadPanes(): Promise<void> {
    const { tree, other, compare } = this.state;
    this.panes[0].tree = await this.tree(tree);
    this.panes[1].tree = compare ? await this.tree(other) : null;
    this.stage.setPanes(compare ? 2 : 1);
  }

  private applyMesh(): void {
    const { members, mesh, wireframe } = this.state;
    const tree = this.panes[0].tree;
    this.meshLayer.setTriangles(members && tree ? Array.from(new Set(tree.prims)) : null);
    this.meshLayer.show({ mesh, wireframe });
  }

  private applyAreas(): void {
    clear(this.areaGroup);
    this.data.areas.forEach((area, i) => {
      if (!this.state.hidden.includes(i)) this.areaGroup.add(areaLines(area, i));
    });
  }

  private applyTop(): void {
    clear(this.topGroup);
    for (const object of topLevelCells(this.top, this.state)) this.topGroup.add(object);
  }

  private applyBoxes(): void {
    const { show, level, colour, filled } = this.state;
    this.panes.forEach((pane, i) => {
      clear(pane.boxGroup);
      const tree = pane.tree;
      if (!tree) return;
      pane.shown = shownNodes(tree, show, Math.min(level, tree.maxLevel));
      const { nodes } = pane.shown;
      pane.colours = nodeColours(tree, colour, this.areaOf(i), pane.visits, nodes);
      const list = {
        count: nodes.length,
        box: (k: number) => tree.boxes.subarray(6 * nodes[k], 6 * nodes[k] + 6),
        colour: (k: number) => (pane.colours as NodeColours).colour(nodes[k]),
      };
      if (nodes.length > 0) pane.boxGroup.add(boxes(list, { filled, opacity: 1 }));
    });
  }

  nodeOf(pane: number): number {
    const node = pane === 0 ? this.state.node : this.state.otherNode;
    const tree = this.panes[pane].tree;
    return tree && Number.isInteger(node) && node >= 0 && node < tree.size ? node : -1;
  }

  choose(pane: number, node: number): void {
    this.store.set(pane === 0 ? { node, focus: 0 } : { otherNode: node, focus: 1 });
  }

  private applyNodes(): void {
    this.panes.forEach((pane, i) => {
      clear(pane.nodeGroup);
      const node = this.nodeOf(i);
      if (pane.tree && node >= 0) this.drawNode(pane, pane.tree, node);
    });
  }

  /** Parent green, left child red, right one blue; their triangles magenta and cyan, a leaf's yellow. */
  private drawNode(pane: Pane, tree: Tree, node: number): void {
    const box = (at: number, colour: Colour): void => {
      const { lo, hi } = boxOf(tree, at);
      pane.nodeGroup.add(boxes({ count: 1, box: () => [...lo, ...hi], colour: () => colour }, { filled: false, opacity: 1, onTop: true }));
    };
    if (tree.parent[node] >= 0) box(tree.parent[node], ROLE_COLOURS.parent);
    box(node, inkColour());
    if (isLeaf(tree, node)) {
      pane.nodeGroup.add(this.meshLayer.highlight(trianglesBelow(tree, node), ROLE_COLOURS.leafTriangles));
      return;
    }
    const left = tree.first[node];
    box(left, ROLE_COLOURS.left);
    box(left + 1, ROLE_COLOURS.right);
    pane.nodeGroup.add(this.meshLayer.highlight(trianglesBelow(tree, left), ROLE_COLOURS.leftTriangles));
    pane.nodeGroup.add(this.meshLayer.highlight(trianglesBelow(tree, left + 1), ROLE_COLOURS.rightTriangles));
  }

  step(to: 'parent' | 'left' | 'right' | 'sibling'): void {
    const pane = this.state.focus;
    const tree = this.panes[pane].tree;
    if (!tree) return;
    const node = this.nodeOf(pane);
    if (node < 0) return this.choose(pane, 0);
    const leaf = isLeaf(tree, node);
    const next = { parent: tree.parent[node], sibling: siblingOf(tree, node), left: leaf ? -1 : tree.first[node], right: leaf ? -1 : tree.first[node] + 1 }[to];
    if (next >= 0) this.choose(pane, next);
  }

  /** The area whose rays are cast: that of the first tree, or else the view. */
  castArea(): Area {
    return this.areaOf(0) ?? this.stage.viewArea();
  }

  private applyRays(): void {
    clear(this.rayGroup);
    this.highlightRay(-1);
    const { cast, rays, seed } = this.state;
    for (const pane of this.panes) pane.stats = pane.visits = null;
    this.rays = [];
    if (!cast) return;
    this.rays = this.ownRays ?? castRays(this.castArea(), BigInt(seed), rays);
    for (const pane of this.panes) {
      if (!pane.tree) continue;
      pane.stats = measureRays(pane.tree, this.mesh, this.rays, this.data.costs);
      const visits = new Uint32Array(pane.tree.size);
      for (const ray of this.rays) search(pane.tree, this.mesh, ray, false, (node) => (visits[node] += 1));
      pane.visits = visits;
    }
    this.rayGroup.add(segments(this.rays.map((_, i) => this.raySegment(i)), false));
  }

  raySegment(i: number): Segment {
    const ray = this.rays[i];
    const hit = this.panes[0].stats?.nearest[i];
    const size = Math.hypot(...ray.direction);
    const far = Math.min(ray.tmax, (diagonal(this.mesh.box) * 1.2) / size);
    const t = hit ? hit.t : far;
    const to = ray.origin.map((x, k) => x + ray.direction[k] * t) as Vec;
    return { from: ray.origin, to, colour: hit ? ROLE_COLOURS.ray : ROLE_COLOURS.miss };
  }

  /** Lights up the boxes that a ray visits in each tree; -1: none. Returns their numbers. */
  highlightRay(index: number): number[] {
    const counts: number[] = [];
    for (const pane of this.panes) {
      clear(pane.visitGroup);
      const tree = pane.tree;
      if (!tree || index < 0 || index >= this.rays.length) continue;
      const visited: number[] = [];
      search(tree, this.mesh, this.rays[index], true, (node) => visited.push(node));
      counts.push(visited.length);
      const list = { count: visited.length, box: (k: number) => tree.boxes.subarray(6 * visited[k], 6 * visited[k] + 6), colour: () => ROLE_COLOURS.ray };
      pane.visitGroup.add(boxes(list, { filled: false, opacity: 1, onTop: true }));
      pane.visitGroup.add(segments([{ ...this.raySegment(index), colour: inkColour() }], true));
    }
    this.stage.requestDraw();
    return counts;
  }

  private whileMoving(moving: boolean): void {
    this.meshLayer.show({ moving });
    for (const pane of this.panes)
      for (const object of pane.boxGroup.children) limitBoxes(object, pane.shown.nodes.length, moving ? MOST_MOVING : Infinity);
  }

  see(area: number): void {
    if (area >= 0) this.stage.seeFrom(this.data.areas[area]);
    else this.stage.fit();
    this.store.set({ light: area, camera: this.stage.cameraNumbers() });
  }
}
