// Elements in one expression.

type Child = Node | string | null;
type Attributes = Record<string, string | number | boolean | ((event: Event) => void)>;

/** `on...` attributes are listeners; false leaves an attribute out. */
export function element<K extends keyof HTMLElementTagNameMap>(
  name: K,
  attributes: Attributes = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  const result = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (typeof value === 'function') result.addEventListener(key.slice(2), value);
    else if (value !== false) result.setAttribute(key, value === true ? '' : String(value));
  }
  result.append(...children.filter((child) => child !== null));
  return result;
}

export function svg(name: string, attributes: Record<string, string | number>, ...children: (Node | string)[]): SVGElement {
  const result = document.createElementNS('http://www.w3.org/2000/svg', name);
  for (const [key, value] of Object.entries(attributes)) result.setAttribute(key, String(value));
  result.append(...children);
  return result;
}

export function button(label: string, title: string, action: () => void): HTMLButtonElement {
  return element('button', { type: 'button', title, onclick: action }, label);
}

export interface Choice {
  value: string;
  label: string;
}

export function select(label: string, choices: Choice[], chosen: (value: string) => void): { row: HTMLElement; set: (value: string) => void } {
  const list = element('select', { 'aria-label': label, onchange: () => chosen(list.value) });
  for (const choice of choices) list.append(element('option', { value: choice.value }, choice.label));
  return { row: element('label', { class: 'row' }, element('span', {}, label), list), set: (value) => (list.value = value) };
}

export function checkbox(label: string, changed: (on: boolean) => void): { row: HTMLElement; set: (on: boolean) => void } {
  const box = element('input', { type: 'checkbox', onchange: () => changed(box.checked) });
  return { row: element('label', { class: 'check' }, box, label), set: (on) => (box.checked = on) };
}

export interface Slider {
  row: HTMLElement;
  set: (value: number, max?: number) => void;
}

export function slider(label: string, limits: { min: number; max: number; step: number }, changed: (value: number) => void): Slider {
  const input = element('input', { type: 'range', 'aria-label': label, ...limits, oninput: () => change() });
  const output = element('output');
  const change = (): void => {
    output.textContent = input.value;
    changed(Number(input.value));
  };
  const set = (value: number, max?: number): void => {
    if (max !== undefined) input.max = String(max);
    input.value = String(value);
    output.textContent = input.value;
  };
  return { row: element('label', { class: 'row' }, element('span', {}, label), input, output), set };
}

/** 4 significant digits, or whole numbers with thin spaces. */
export function numberText(value: number): string {
  if (!Number.isFinite(value)) return '-';
  if (Number.isInteger(value) && Math.abs(value) < 1e15) return String(value).replace(/\B(?=(\d{3})+$)/g, '\u2009');
  const size = Math.abs(value);
  return size >= 1e-3 && size < 1e6 ? String(Number(value.toPrecision(4))) : value.toExponential(3);
}

export function table(head: string[], rows: (string | Node)[][]): HTMLTableElement {
  const line = (cells: (string | Node)[], tag: 'th' | 'td'): HTMLElement => element('tr', {}, ...cells.map((cell) => element(tag, {}, cell)));
  return element('table', {}, element('thead', {}, line(head, 'th')), element('tbody', {}, ...rows.map((row) => line(row, 'td'))));
}

export function save(name: string, blob: Blob): void {
  const link = element('a', { href: URL.createObjectURL(blob), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}
