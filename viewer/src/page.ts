// Elements of the page: finding, making, writing them only when they change.

export function element<T extends HTMLElement = HTMLElement>(id: string): T {
  const found = document.getElementById(id);
  if (!found) throw new Error(`page has no element ${id}`);
  return found as T;
}

type Child = Node | string;

export function make<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  class_name = "",
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  const made = document.createElement(tag);
  if (class_name !== "") made.className = class_name;
  made.append(...children);
  return made;
}

export function make_button(text: string, title: string, on_click: () => void): HTMLButtonElement {
  const button = make("button", "", text);
  button.type = "button";
  button.title = title;
  button.addEventListener("click", on_click);
  return button;
}

export function make_check_box(
  text: string,
  is_checked: boolean,
  on_change: (is_checked: boolean) => void,
): HTMLLabelElement {
  const box = make("input");
  box.type = "checkbox";
  box.checked = is_checked;
  box.addEventListener("change", () => on_change(box.checked));
  return make("label", "check", box, text);
}

export function write(part: HTMLElement, text: string): void {
  if (part.textContent !== text) part.textContent = text;
}

// Fills a bar (its first child) from the left, share 0..1.
export function fill(bar: HTMLElement, share: number): void {
  const part = bar.firstElementChild as HTMLElement;
  const scale = `scaleX(${Math.min(1, Math.max(0, share)).toFixed(3)})`;
  if (part.style.transform !== scale) part.style.transform = scale;
}

// Keys belong to the field that one writes into, not to the page.
export function is_typing({ target }: Event): boolean {
  const is_text = target instanceof HTMLInputElement && target.type === "text";
  return is_text || target instanceof HTMLSelectElement;
}

export function download(blob: Blob, name: string): void {
  const link = make("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}
