// What the browser remembers of how the page was left: only choices of the page's own lists.

export function remember(name: string, value: string): void {
  try {
    localStorage.setItem(name, value);
  } catch {
    // a browser that stores nothing forgets it
  }
}

export function remembered<T extends string>(name: string, choices: readonly T[], first: T): T {
  try {
    const value = localStorage.getItem(name);
    return choices.find((choice) => choice === value) ?? first;
  } catch {
    return first;
  }
}
