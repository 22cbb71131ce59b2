// axe-core judges what a page shows now: light and dark.
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";

const SOURCE = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const RULES = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa", "best-practice"];

// Violations in words, empty: none.
export async function violations(page) {
  const found = [];
  if (!(await page.evaluate(() => "axe" in window))) await page.evaluate(SOURCE);
  for (const colorScheme of ["light", "dark"]) {
    await page.emulateMedia({ colorScheme });
    await page.waitForFunction((theme) => document.documentElement.dataset.theme === theme, colorScheme);
    const texts = await page.evaluate(async (values) => {
      const result = await window.axe.run({ iframes: false, runOnly: { type: "tag", values } });
      return result.violations.map(({ id, nodes }) => {
        const [{ html, any }] = nodes;
        return `${id} (${nodes.length}): ${html.slice(0, 140)} ${any[0]?.message ?? ""}`;
      });
    }, RULES);
    found.push(...texts.map((text) => `${colorScheme}: ${text}`));
  }
  await page.emulateMedia({ colorScheme: "light" });
  return found;
}
