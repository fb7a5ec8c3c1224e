// Which nodes of a tree are drawn, and in which colours.
import { overlapOf, type Area } from './area';
import { boxColour, randomColour, type Colour } from './colours';
import type { ColourBy, Show } from './state';
import { boxOf, isLeaf, probabilityOf, siblingOf, type Tree } from './tree';

/** More boxes than this are too many for a picture. */
export const MOST_BOXES = 120_000;

export interface ShownNodes {
  /** The largest first, where some were left out. */
  nodes: Uint32Array;
  /** How many there are in all. */
  total: number;
}

function halfArea(tree: Tree, node: number): number {
  const b = 6 * node;
  const x = tree.boxes[b + 3] - tree.boxes[b];
  const y = tree.boxes[b + 4] - tree.boxes[b + 1];
  const z = tree.boxes[b + 5] - tree.boxes[b + 2];
  return x * y + y * z + z * x;
}

function isShown(tree: Tree, node: number, show: Show, level: number): boolean {
  if (show === 'all') return true;
  if (show === 'leaves') return isLeaf(tree, node);
  return show === 'level' && tree.level[node] === level;
}

export function shownNodes(tree: Tree, show: Show, level: number): ShownNodes {
  const found: number[] = [];
  if (show !== 'none') for (let node = 0; node < tree.size; ++node) if (isShown(tree, node, show, level)) found.push(node);
  const nodes = Uint32Array.from(found);
  const sizes = new Float32Array(tree.size);
  for (const node of found) sizes[node] = halfArea(tree, node);
  nodes.sort((a, b) => sizes[b] - sizes[a]);
  return { nodes: nodes.slice(0, MOST_BOXES), total: found.length };
}

export interface NodeColours {
  colour: (node: number) => Colour;
  /** What the ends of the scale mean; null where colours mean nothing. */
  scale: { low: number; high: number; logarithmic: boolean; title: string } | null;
}

export function nodeColours(tree: Tree, by: ColourBy, area: Area | null, visits: Uint32Array | null, nodes: Uint32Array): NodeColours {
  switch (by) {
    case 'depth':
      return {
        colour: (node) => boxColour(tree.level[node] / Math.max(tree.maxLevel, 1)),
        scale: { low: 0, high: tree.maxLevel, logarithmic: false, title: 'level' },
      };
    case 'measure': {
      const floor = 1e-6;
      return {
        colour: (node) => boxColour(1 + Math.log10(Math.max(probabilityOf(tree, node), floor)) / 6),
        scale: { low: floor, high: 1, logarithmic: true, title: 'probability of being met' },
      };
    }
    case 'overlap':
      return {
        colour: (node) => {
          const sibling = siblingOf(tree, node);
          const share = area && sibling >= 0 ? overlapOf(area, boxOf(tree, node), boxOf(tree, sibling), true).share : 0;
          return boxColour(share);
        },
        scale: { low: 0, high: 1, logarithmic: false, title: area ? 'overlap with the sibling, as the area sees it' : 'overlap needs an area' },
      };
    case 'visits': {
      let most = 1;
      if (visits) for (const node of nodes) most = Math.max(most, visits[node]);
      return {
        colour: (node) => boxColour((visits?.[node] ?? 0) / most),
        scale: { low: 0, high: most, logarithmic: false, title: visits ? 'rays that meet the box' : 'cast rays to see visits' },
      };
    }
    default:
      return { colour: randomColour, scale: null };
  }
}
