// Pictures of all screens of the pages of a study, with the canned study of mock.mjs.
//
//   node test/study/screenshots.mjs FOLDER
import { mkdirSync } from "node:fs";
import { join } from "node:path";

import { drive, open, start_browser } from "./keyboard.mjs";
import { Mock } from "./mock.mjs";

const folder = process.argv[2] ?? "test/output";
mkdirSync(folder, { recursive: true });
const LOOKS = [
  { name: "phone", viewport: { width: 390, height: 844 }, colorScheme: "light", language: "de", hasTouch: true },
  { name: "tablet", viewport: { width: 1180, height: 820 }, colorScheme: "dark", language: "de" },
  { name: "tablet-light", viewport: { width: 1180, height: 820 }, colorScheme: "light", language: null },
  { name: "desktop", viewport: { width: 1600, height: 900 }, colorScheme: "light", language: null },
  { name: "desktop-dark", viewport: { width: 1600, height: 900 }, colorScheme: "dark", language: null },
];

const browser = await start_browser();
for (const { name, language, ...options } of LOOKS) {
  for (const hand of ["mouse", "device"]) {
    const mock = new Mock();
    mock.hand = hand;
    mock.rest_s = 1;
    const links = await mock.listen();
    const operator = await open(browser, links.operator, options);
    const participant = await open(browser, links.participant, options);
    let count = 0;
    const seen = new Set();
    const look = async (screen, page, leading, phase = "closed") => {
      for (const [what, looked] of [[screen, page], [`operator-${phase}`, leading]]) {
        const position = what === screen ? await page.evaluate(() => document.body.dataset.position) : "";
        const key = `${what}${position}`;
        if (seen.has(key)) continue;
        if (hand === "device" && !["trial", "operator-running"].includes(what)) continue;
        seen.add(key);
        if (phase === "running") await page.waitForTimeout(2500);
        const file = `${name}-${hand}-${String(++count).padStart(2, "0")}-${what}.png`;
        await looked.screenshot({ path: join(folder, file), fullPage: what === "form" || name === "phone" });
      }
    };
    await drive(operator.page, participant.page, { trial_s: 3, language, look });
    await operator.context.close();
    await participant.context.close();
    mock.close();
  }
}
await browser.close();
