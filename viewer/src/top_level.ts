// The octree over the areas.
import { unpack, type ViewData } from './data';
import type { Box } from './vec';

export interface Cell {
  node: number;
  level: number;
  box: Box;
  areas: number[];
}

export interface TopLevel {
  nodes: number;
  leaves: Cell[];
}

export async function loadTopLevel(data: ViewData): Promise<TopLevel> {
  const { boxes, children, counts, lists } = await unpack(data.topLevel);
  const level = new Uint8Array(children.length);
  const leaves: Cell[] = [];
  for (let node = 0, at = 0; node < children.length; ++node) {
    if (children[node] !== 0) {
      for (let i = 0; i < 8; ++i) level[children[node] + i] = level[node] + 1;
      continue;
    }
    const b = boxes.subarray(6 * node, 6 * node + 6);
    const areas = Array.from(lists.subarray(at, at + counts[node]));
    at += counts[node];
    leaves.push({ node, level: level[node], box: { lo: [b[0], b[1], b[2]], hi: [b[3], b[4], b[5]] }, areas });
  }
  return { nodes: children.length, leaves };
}
