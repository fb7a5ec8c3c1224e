// What the program put into the page: a JSON text, and packed arrays that are unpacked when they are wanted.
import type { Area } from './area';

export type Numbers = Float32Array | Uint32Array | Uint8Array;

interface ArrayPlace {
  type: 'f32' | 'f24' | 'u32' | 'share' | 'u8';
  offset: number;
  count: number;
}

export interface BlobPlace {
  start: number;
  length: number;
  bytes: number;
  arrays: Record<string, ArrayPlace>;
}

export interface NamedValue {
  name: string;
  unit: string;
  value: number;
  meaning: string;
}

export interface TreeInfo {
  recipe: string;
  /** Index of its area; -1 for a tree of the whole scene. */
  area: number;
  nodes: number;
  total: number;
  values: NamedValue[];
  data: BlobPlace;
}

export interface Costs {
  inner: number;
  triangle: number;
}

export interface ViewData {
  format: string;
  version: number;
  scene: string;
  triangles: number;
  vertices: number;
  seed: string;
  costs: Costs;
  mesh: BlobPlace;
  areas: Area[];
  trees: TreeInfo[];
  topLevel: BlobPlace;
}

let packed: string | null = null;

function elementText(id: string): string {
  return document.getElementById(id)?.textContent ?? '';
}

export function readData(): ViewData {
  packed = null;
  const data = JSON.parse(elementText('view-data')) as ViewData;
  if (data.format !== 'raygrain-view' || data.version !== 1) throw new Error('The data of this page are of another version.');
  return data;
}

function fromBase64(text: string): Uint8Array<ArrayBuffer> {
  const bytes = new Uint8Array((text.length / 4) * 3 - (text.endsWith('==') ? 2 : text.endsWith('=') ? 1 : 0));
  const step = 1 << 18; // a multiple of 4
  for (let at = 0, to = 0; at < text.length; at += step) {
    const part = atob(text.slice(at, at + step));
    for (let i = 0; i < part.length; ++i) bytes[to++] = part.charCodeAt(i);
  }
  return bytes;
}

async function inflated(bytes: Uint8Array<ArrayBuffer>): Promise<Uint8Array> {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** The numbers of one array from its planes of bytes. */
export function unpackArray(bytes: Uint8Array, place: ArrayPlace): Numbers {
  const { offset, count, type } = place;
  const plane = (k: number): Uint8Array => bytes.subarray(offset + k * count, offset + (k + 1) * count);
  if (type === 'u8') return plane(0).slice();
  const planes = Array.from({ length: type === 'share' ? 2 : type === 'f24' ? 3 : 4 }, (_, k) => plane(k));
  const words = new Uint32Array(count);
  const shift = type === 'f24' ? 8 : 0;
  planes.forEach((p, k) => {
    const by = 8 * k + shift;
    for (let i = 0; i < count; ++i) words[i] |= p[i] << by;
  });
  if (type === 'f32' || type === 'f24') return new Float32Array(words.buffer);
  if (type === 'share') return Float32Array.from(words, (word) => word / 65535);
  for (let i = 0, before = 0; i < count; ++i) before = words[i] = (before + ((words[i] >>> 1) ^ -(words[i] & 1))) >>> 0;
  return words;
}

export async function unpack(place: BlobPlace): Promise<Record<string, Numbers>> {
  packed ??= elementText('view-blobs').trimStart();
  const bytes = await inflated(fromBase64(packed.slice(place.start, place.start + place.length)));
  if (bytes.length !== place.bytes) throw new Error('The data of this page are damaged.');
  return Object.fromEntries(Object.entries(place.arrays).map(([name, array]) => [name, unpackArray(bytes, array)]));
}
