// Markdown of a study as elements. HTML in it is left out.

import { HtmlRenderer, Parser } from "commonmark";

const parser = new Parser();
const renderer = new HtmlRenderer({ safe: true });

// Headings begin below that of the page.
export function html_of(markdown: string): string {
  const tree = parser.parse(markdown);
  const walker = tree.walker();
  for (let step = walker.next(); step; step = walker.next()) {
    const { node } = step;
    if (step.entering && node.type === "heading") node.level = Math.min(6, node.level + 1) as typeof node.level;
  }
  return renderer.render(tree);
}

export function show_markdown(part: HTMLElement, markdown: string): void {
  part.innerHTML = html_of(markdown);
}
