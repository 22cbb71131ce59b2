// Pictures of all screens of the pages of a study, with the canned study of mock.mjs.
//
//   node test/study/screenshots.mjs FOLDER
import { mkdirSync } from "node:fs";
import { join } from "node:path";

import { drive, fill_items, open, press, start_browser, tab_to, until } from "./keyboard.mjs";
import { Mock, lead_to } from "./mock.mjs";

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

// What a whole session does not show: missing answers, a question, lost connections.
for (const [name, options] of [
  ["phone", { viewport: { width: 390, height: 844 } }],
  ["desktop", { viewport: { width: 1600, height: 900 } }],
  ["zoomed", { viewport: { width: 640, height: 400 }, colorScheme: "dark" }], // 1280 x 800 at 200 %
]) {
  const mock = new Mock();
  const links = await mock.listen();
  const operator = await open(browser, links.operator, options);
  const { page } = await open(browser, links.participant, options);
  const picture = (looked, what) =>
    looked.screenshot({ path: join(folder, `${name}-special-${what}.png`), fullPage: true });
  lead_to(mock, "form", "tlx");
  await until(page, () => document.body.dataset.screen === "form");
  await tab_to(page, "[role=slider]");
  for (let i = 0; i < 8; i++) await page.keyboard.press("ArrowRight");
  await press(page, ".main");
  await picture(page, "missing");
  lead_to(mock, "trial");
  await until(operator.page, () => document.body.dataset.phase === "ready");
  await picture(operator.page, "ready");
  await operator.page.keyboard.press("s");
  await until(operator.page, () => document.body.dataset.phase === "running");
  await press(operator.page, "#do-abort");
  await operator.page.keyboard.press("Enter");
  await picture(operator.page, "why");
  mock.do_stop();
  mock.send_state();
  await until(operator.page, () => document.body.dataset.phase === "failed");
  await press(operator.page, "#note");
  await operator.page.keyboard.type("The phone rang.");
  await operator.page.keyboard.press("Enter");
  await picture(operator.page, "failed");
  lead_to(mock, "form", "impression");
  await until(page, () => document.querySelector("textarea"));
  await fill_items(page);
  mock.deaf = true;
  mock.cut();
  await until(page, () => document.body.dataset.connected === "false");
  await press(page, ".main");
  await picture(page, "lost");
  await until(operator.page, () => document.body.dataset.connected === "false");
  await picture(operator.page, "operator-lost");
  await operator.context.close();
  await page.context().close();
  mock.close();
}
await browser.close();
