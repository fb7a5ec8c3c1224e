// Elements in one expression.

type Child = Node | string | null | undefined | false;

export function element<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Record<string, string> = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  const result = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) result.setAttribute(name, value);
  for (const child of children) if (child) result.append(child);
  return result;
}

export function button(text: string, title: string, onClick: () => void): HTMLButtonElement {
  const result = element('button', { type: 'button', title }, text);
  result.addEventListener('click', onClick);
  return result;
}

/** Saves a text or picture under a name. */
export function download(name: string, content: Blob): void {
  const url = URL.createObjectURL(content);
  const link = element('a', { href: url, download: name });
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(url), 10_000);
}
