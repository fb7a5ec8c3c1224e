// Says in the page whether something is still to be done or drawn: for tests, and for whoever takes pictures.

let open = 0;

export function begin(): void {
  open += 1;
  document.documentElement.dataset.busy = 'true';
}

export function end(): void {
  open -= 1;
  if (open === 0) document.documentElement.dataset.busy = 'false';
}
