// Colours that stand for numbers: lightness rises evenly with the number, so they are safe for colour-blind readers.

export type Colour = [number, number, number];

const RAMP: Colour[] = [
  [0, 0, 20],
  [40, 11, 84],
  [101, 21, 110],
  [159, 42, 99],
  [212, 72, 66],
  [245, 125, 21],
  [250, 193, 39],
  [252, 255, 164],
];
const DIVERGING: Colour[] = [
  [33, 102, 172],
  [146, 197, 222],
  [247, 247, 247],
  [244, 165, 130],
  [178, 24, 43],
];

function along(stops: Colour[], share: number): Colour {
  const at = Math.min(Math.max(Number.isFinite(share) ? share : 0, 0), 1) * (stops.length - 1);
  const i = Math.min(Math.floor(at), stops.length - 2);
  const f = at - i;
  return [0, 1, 2].map((k) => Math.round(stops[i][k] + (stops[i + 1][k] - stops[i][k]) * f)) as Colour;
}

/** Of a share in [0, 1]: dark to light. */
export const rampColour = (share: number): Colour => along(RAMP, share);
/** Of a number in [-1, 1]: blue, white, red. */
export const divergingColour = (value: number): Colour => along(DIVERGING, (value + 1) / 2);
/** Of boxes: without the darkest part, which would not be seen on dark. */
export const boxColour = (share: number): Colour => rampColour(0.22 + 0.78 * Math.min(Math.max(share, 0), 1));

/** A bar in the colours of a function, for numbers from `low` to `high`. */
export function gradient(colour: (at: number) => Colour, low: number, high: number): string {
  const stops = Array.from({ length: 17 }, (_, i) => css(colour(low + ((high - low) * i) / 16)));
  return `linear-gradient(to right, ${stops.join()})`;
}

/** Always the same one for a number, and unlike its neighbours'. */
export function randomColour(index: number): Colour {
  const hue = (index * 0.61803398875) % 1;
  const channel = (shift: number): number => Math.round(255 * (0.6 + 0.35 * Math.cos(2 * Math.PI * (hue + shift))));
  return [channel(0), channel(1 / 3), channel(2 / 3)];
}

/** As the paper's visualizer has them. */
export const ROLE_COLOURS = {
  parent: [64, 200, 64],
  left: [230, 60, 60],
  right: [70, 110, 255],
  leftTriangles: [255, 0, 255],
  rightTriangles: [0, 255, 255],
  leafTriangles: [255, 255, 0],
  ray: [255, 170, 40],
  miss: [120, 130, 150],
} satisfies Record<string, Colour>;

export const css = (colour: Colour): string => `rgb(${colour.join()})`;

/** Of what is chosen: dark on light, light on dark. */
export function inkColour(): Colour {
  const parts = getComputedStyle(document.documentElement).getPropertyValue('--ink').trim();
  return [1, 3, 5].map((at) => parseInt(parts.slice(at, at + 2), 16)) as Colour;
}
