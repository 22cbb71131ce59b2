// A remote machine on the page: it is drawn, led, held back by its wall, and released by the clutch.
// Each case gets {browser, command, expect}, as those of cases.mjs; none needs the shared program.
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";

import { violations } from "../study/axe.mjs";
import {
  NO_SPACE,
  cheap,
  comes_true,
  drag_along,
  frame_of,
  hide_and_compare,
  lives,
  open_page,
  page_comes_to,
  scene_of,
  start_browser,
  start_program,
} from "./browser.mjs";

const root = resolve(dirname(fileURLToPath(import.meta.url)), "../../..");
const FINGER = 44; // px
const SMALLEST = 1500; // pixels of the remote machine

// The shipped scenario with a hand of ours, and a link that does not break down meanwhile.
async function with_remote_arm({ command, expect }, use) {
  if (!command.includes("run")) return; // the demonstration server has no remote machine
  const folder = mkdtempSync(join(tmpdir(), "teleoperation-"));
  const shipped = readFileSync(join(root, "models/scenarios/remote_arm.yaml"), "utf8");
  const calm = shipped.replace(/ {4}outages:\n.*\n/, "").replaceAll(": ../", `: ${root}/models/`);
  expect(!calm.includes("outages"), "the scenario without outages");
  writeFileSync(join(folder, "calm_arm.yaml"), calm);
  const program = await start_program([
    command[0], "run", join(folder, "calm_arm.yaml"), "--user", "mouse", "--no-recording",
  ]);
  await use(program);
  await program.stop();
  rmSync(folder, { recursive: true });
}

const engaged = (page) => comes_true(page, (f) => f.teleoperation.link === "engaged");

// Drags the handle sideways, to `y_m` beyond where it is, and calls `at_end` while it is held there.
async function drag_sideways(page, y_m, at_end) {
  const { p_B_H_m } = await frame_of(page);
  const steps = [0.25, 0.5, 0.75, 1].map((share) => [p_B_H_m[0], p_B_H_m[1] + share * y_m, p_B_H_m[2]]);
  await drag_along(page, steps, at_end);
}

export async function a_remote_machine_is_shown({ browser, command, expect }) {
  await with_remote_arm({ command, expect }, async (program) => {
    const { page, problems, close } = await open_page(browser, cheap(program.link));
    expect(await page.isVisible("#remote"), "the tab of the remote machine is open");
    const pixels = await hide_and_compare(page, "remote");
    expect(pixels >= SMALLEST, `the remote machine covers ${pixels} pixels`);
    await page.locator("#legend").evaluate((legend) => (legend.open = true));
    const lines = await page.locator("#legend li:visible").allInnerTexts();
    for (const text of ["robot (device)", "remote machine", "where it is to be (ghost)"]) {
      expect(lines.includes(text), `the legend has ${text}`);
    }
    expect(await engaged(page), "the clutch is engaged");
    const said = await page.textContent("#remote");
    for (const word of ["there and back", "jitter", "packets lost", "operator's port", "remote port", "Model mediated"]) {
      expect(said.includes(word), `the panel says: ${word}`);
    }
    const measured = await comes_true(page, ({ teleoperation: t }) => t.round_trip_s > 0.2 && t.loss > 0.01 && t.loss < 0.12);
    const { round_trip_s, loss } = (await frame_of(page)).teleoperation;
    expect(measured, `the link is measured: ${round_trip_s} s there and back, ${loss} lost`);
    expect((await page.locator(".remote-plot canvas").count()) > 0, "energies are plotted");
    const found = await violations(page);
    expect(found.length === 0, `axe-core finds nothing, light and dark: ${found.join("; ")}`);
    await page.keyboard.press("?");
    expect(/clutch/.test(await page.textContent("#keys")), "? names the key of the clutch");
    expect(problems.length === 0, `no errors or foreign requests: ${problems.join("; ") || "none"}`);
    await close();
  });
}

export async function the_mouse_leads_a_remote_machine({ browser, command, expect }) {
  await with_remote_arm({ command, expect }, async (program) => {
    const { page, problems, close } = await open_page(browser, cheap(program.link));
    await engaged(page);
    const sentence = () => page.textContent("#who-holds");
    expect(/follows your hand/.test(await sentence()), `at first: ${await sentence()}`);
    await drag_sideways(page, 0.35, async () => {
      const is_met = await comes_true(page, ({ teleoperation: t }) => t.x_remote[1] > 0.19 && Math.hypot(...t.f_leader) > 2);
      expect(is_met, "the hand leads it to its wall, and feels it");
      // on its way to rest at the wall the machine may be at its acceleration for a moment
      const says_so = () => /presses something.*holds you back with \d/.test(document.getElementById("who-holds").textContent);
      await page_comes_to(page, says_so);
      expect(/presses something.*holds you back with \d/.test(await sentence()), `it says so: ${await sentence()}`);
      await page.keyboard.press("c");
      const is_open = await comes_true(page, ({ teleoperation: t }) => t.is_clutch_open && t.link === "released");
      expect(is_open, "C opens the clutch while the mouse drags");
      expect(await comes_true(page, ({ teleoperation: t }) => Math.hypot(...t.f_leader) === 0), "and the force fades");
    });
    await lives(page, 1); // until the released machine is at rest
    const { x_remote } = (await frame_of(page)).teleoperation;
    await drag_sideways(page, -0.2, async () => {});
    const [, stayed] = (await frame_of(page)).teleoperation.x_remote;
    expect(Math.abs(stayed - x_remote[1]) < 0.005, `it stays while the hand moves: ${x_remote[1]}, ${stayed} m`);
    const button = page.locator("#clutch");
    const { width, height } = await button.boundingBox();
    expect(width >= FINGER && height >= FINGER, `the button is large enough for a finger: ${width} x ${height}`);
    const label = await button.getAttribute("aria-label");
    expect(/^Clutch: open \(C\)\. Opens and closes the clutch/.test(label), `and has a name: ${label}`);
    await button.click();
    expect(await engaged(page), "it closes the clutch");
    const [, closed] = (await frame_of(page)).teleoperation.x_remote;
    expect(Math.abs(closed - stayed) < 0.005, `and nothing jumps: ${closed} m`);
    await page.keyboard.down("c");
    await comes_true(page, (f) => f.teleoperation.is_clutch_open);
    await page.waitForTimeout(600);
    await page.keyboard.up("c");
    expect(await engaged(page), "a key that is held opens it only meanwhile");
    expect(problems.length === 0, `no errors or foreign requests: ${problems.join("; ") || "none"}`);
    await close();
  });
}

export async function another_page_does_not_work_the_clutch({ browser, command, expect }) {
  await with_remote_arm({ command, expect }, async (program) => {
    const first = await open_page(browser, cheap(program.link));
    const second = await open_page(browser, cheap(program.link));
    await engaged(first.page);
    await first.page.keyboard.down("d"); // takes the hand
    await comes_true(second.page, (f) => f.hand_page !== 0);
    await page_comes_to(second.page, () => document.body.dataset.hand === "taken");
    expect(!(await second.page.isVisible("#clutch")), "who has not the hand has no clutch");
    await second.page.keyboard.press("c");
    const { time_s } = await frame_of(second.page);
    await comes_true(second.page, (f) => f.time_s > time_s + 0.5);
    expect(!(await frame_of(second.page)).teleoperation.is_clutch_open, "and no key for it");
    await first.page.keyboard.up("d");
    await first.close();
    await second.close();
  });
}

export async function a_remote_machine_is_drawn_without_webgl({ command, expect }) {
  await with_remote_arm({ command, expect }, async (program) => {
    const browser = await start_browser(NO_SPACE);
    const { page, problems } = await open_page(browser, cheap(program.link));
    await engaged(page);
    const { teleoperation } = await scene_of(page);
    const count = () =>
      page.evaluate(() => {
        const [r, g, b] = [0x47, 0x78, 0x0a]; // --remote of the light theme
        return [...document.querySelectorAll(".flat canvas")].map((canvas) => {
          const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
          let found = 0;
          for (let i = 0; i < data.length; i += 4) {
            if (data[i + 3] > 100 && Math.hypot(data[i] - r, data[i + 1] - g, data[i + 2] - b) < 40) found += 1;
          }
          return found;
        });
      });
    const pixels = await count();
    expect(teleoperation !== null && pixels.every((found) => found > 200), `both views have it: ${pixels} pixels`);
    expect(problems.length === 0, `no errors or foreign requests: ${problems.join("; ") || "none"}`);
    await browser.close();
  });
}
