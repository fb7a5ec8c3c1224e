// The cells of the octree over the areas, each in the mean colour of its areas.
import type { Object3D } from 'three';
import { inkColour, randomColour, type Colour } from '../colours';
import type { State } from '../state';
import type { Cell, TopLevel } from '../top_level';
import type { Box } from '../vec';
import { boxes } from './box_layer';

const flat = ({ lo, hi }: Box): number[] => [...lo, ...hi];

function meanColour(cell: Cell): Colour {
  const all = cell.areas.map((area) => randomColour(area + 3));
  return [0, 1, 2].map((k) => all.reduce((sum, c) => sum + c[k], 0) / all.length) as Colour;
}

/** Those of areas that are shown, as the state wants them, and the chosen one's outline. */
export function topLevelCells(topLevel: TopLevel, { top, cell, hidden }: State): Object3D[] {
  const objects: Object3D[] = [];
  const cells = topLevel.leaves.filter((leaf) => leaf.areas.some((area) => !hidden.includes(area)));
  const list = { count: cells.length, box: (i: number) => flat(cells[i].box), colour: (i: number) => meanColour(cells[i]) };
  if (top === 'leaves' || top === 'both') objects.push(boxes(list, { filled: true, opacity: Math.min(0.3, 0.5 / Math.cbrt(cells.length)) }));
  if (top === 'wireframe' || top === 'both') objects.push(boxes(list, { filled: false, opacity: 1 }));
  const chosen = topLevel.leaves[cell];
  if (chosen && top !== 'none')
    objects.push(boxes({ count: 1, box: () => flat(chosen.box), colour: inkColour }, { filled: false, opacity: 1, onTop: true }));
  return objects;
}
