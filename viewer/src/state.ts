// What is shown. All of it is in the page's address, so that a link restores the view.

export type Show = 'none' | 'all' | 'level' | 'leaves';
export type ColourBy = 'depth' | 'measure' | 'overlap' | 'visits' | 'random';
export type TopShow = 'none' | 'leaves' | 'wireframe' | 'both';
export type CostMode = 'wiper' | 'beside' | 'difference';
export type CostWhat = 'cost' | 'visits';

export interface State {
  tree: number;
  /** The other tree of comparisons and cost maps. */
  other: number;
  compare: boolean;
  show: Show;
  level: number;
  colour: ColourBy;
  filled: boolean;
  /** Chosen nodes of both trees, and which of the two is spoken of. */
  node: number;
  otherNode: number;
  focus: number;
  mesh: boolean;
  wireframe: boolean;
  /** Draw only the triangles of the tree. */
  members: boolean;
  /** 0: none, 1 ... 3: across x, y, z. */
  section: number;
  sectionAt: number;
  /** 0 ... 2 */
  up: number;
  /** Indices of hidden areas. */
  hidden: number[];
  top: TopShow;
  cell: number;
  rays: number;
  seed: string;
  cast: boolean;
  cost: boolean;
  costMode: CostMode;
  costWhat: CostWhat;
  costSize: number;
  costPruned: boolean;
  /** Whose view the cost is shown from: an area's, or -1 for that of the camera. */
  costFrom: number;
  wiper: number;
  /** The area that the camera stands in for, or -1. */
  light: number;
  /** Position, target and zoom. */
  camera: number[];
  theme: 'auto' | 'light' | 'dark';
}

export const DEFAULTS: State = {
  tree: 0,
  other: 0,
  compare: false,
  show: 'level',
  level: 4,
  colour: 'depth',
  filled: false,
  node: -1,
  otherNode: -1,
  focus: 0,
  mesh: true,
  wireframe: false,
  members: false,
  section: 0,
  sectionAt: 50,
  up: 1,
  hidden: [],
  top: 'none',
  cell: -1,
  rays: 200,
  seed: '1',
  cast: false,
  cost: false,
  costMode: 'wiper',
  costWhat: 'cost',
  costSize: 192,
  costPruned: true,
  costFrom: 0,
  wiper: 50,
  light: -1,
  camera: [],
  theme: 'auto',
};

export type Key = keyof State;

/** Only what differs from the defaults. */
export function toHash(state: State, defaults: State): string {
  const parts: string[] = [];
  for (const key of Object.keys(defaults) as Key[]) {
    const text = String(state[key]);
    if (text !== String(defaults[key])) parts.push(`${key}=${encodeURIComponent(text)}`);
  }
  return parts.join('&');
}

function parseAs(like: State[Key], text: string): State[Key] | null {
  if (typeof like === 'boolean') return text === 'true';
  if (typeof like === 'string') return text;
  if (Array.isArray(like)) return text === '' ? [] : text.split(',').map(Number).filter(Number.isFinite);
  const number = Number(text);
  return Number.isFinite(number) ? number : null;
}

const WORDS: Partial<Record<Key, string[]>> = {
  show: ['none', 'all', 'level', 'leaves'],
  colour: ['depth', 'measure', 'overlap', 'visits', 'random'],
  top: ['none', 'leaves', 'wireframe', 'both'],
  costMode: ['wiper', 'beside', 'difference'],
  costWhat: ['cost', 'visits'],
  theme: ['auto', 'light', 'dark'],
};
const LIMITS: Partial<Record<Key, [number, number]>> = {
  rays: [1, 5000],
  section: [0, 3],
  sectionAt: [0, 100],
  up: [0, 2],
  costSize: [32, 512],
  wiper: [0, 100],
  level: [0, 256],
  focus: [0, 1],
};

const WHOLE: Key[] = ['rays', 'section', 'up', 'costSize', 'level', 'focus'];

function isLegal(key: Key, value: State[Key]): boolean {
  const words = WORDS[key];
  if (words) return words.includes(value as string);
  if (key === 'seed') return /^\d{1,20}$/.test(value as string);
  const limits = LIMITS[key];
  if (WHOLE.includes(key) && !Number.isInteger(value)) return false;
  return limits ? (value as number) >= limits[0] && (value as number) <= limits[1] : true;
}

/** Words that make no sense are passed over. */
export function fromHash(hash: string, defaults: State): State {
  const state: State = { ...defaults };
  for (const part of hash.replace(/^#/, '').split('&')) {
    const at = part.indexOf('=');
    const key = part.slice(0, at) as Key;
    if (at < 0 || !(key in defaults)) continue;
    let text = part.slice(at + 1);
    try {
      text = decodeURIComponent(text);
    } catch {
      continue;
    }
    const value = parseAs(defaults[key], text);
    if (value !== null && isLegal(key, value)) Object.assign(state, { [key]: value });
  }
  return state;
}

export type Listener = (changed: Set<Key>) => void;

export class Store {
  state: State;
  private readonly listeners: Listener[] = [];

  constructor(
    initial: State,
    private readonly defaults: State,
  ) {
    this.state = initial;
  }

  on(listener: Listener): void {
    this.listeners.push(listener);
  }

  set(patch: Partial<State>): void {
    const changed = new Set((Object.keys(patch) as Key[]).filter((key) => String(patch[key]) !== String(this.state[key])));
    if (changed.size === 0) return;
    this.state = { ...this.state, ...patch };
    for (const listener of this.listeners) listener(changed);
    this.write();
  }

  private writing = 0;

  /** The address follows a little later: browsers limit how often it may change. */
  private write(): void {
    clearTimeout(this.writing);
    this.writing = setTimeout(() => history.replaceState(null, '', `#${this.hash()}`), 200) as unknown as number;
  }

  hash(): string {
    return toHash(this.state, this.defaults);
  }
}
