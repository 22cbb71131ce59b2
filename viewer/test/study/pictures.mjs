// Makes docs/images/study_operator.png and study_form.png: a rehearsal of the shipped study.
//
//   node test/study/pictures.mjs PROGRAM
import { spawn, spawnSync } from "node:child_process";
import { appendFileSync, mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { fileURLToPath } from "node:url";

import { drive, open, start_browser, tab_to, until } from "./keyboard.mjs";

const program = resolve(process.argv[2] ?? "../build/release/hapticgiant");
const images = fileURLToPath(new URL("../../../docs/images", import.meta.url));
const folder = mkdtempSync(join(tmpdir(), "study_"));
const LONGEST_TRIAL_S = 60; // they end by themselves
const WIDE_ENOUGH = 3; // events, of the door
const ANSWERS = [4, 2]; // steps of the first scales

const file = join(folder, "study.yaml");
if (spawnSync(program, ["study", "new", file], { stdio: "inherit" }).status !== 0) process.exit(1);
appendFileSync(file, "\ntrial: {pause_s: 20}\nfixed: {duration_s: 40}\n"); // time for a picture, however slowly the machine draws
const child = spawn(program, ["study", "run", file, "--rehearse", "--no-browser"], { stdio: ["ignore", "pipe", "inherit"] });
const ended = new Promise((done) => child.once("exit", done));
const links = await new Promise((found, failed) => {
  let text = "";
  child.stdout.on("data", (part) => {
    text += part;
    const all = /operator +(\S+)\s+participant +(\S+)/.exec(text);
    if (all) found({ operator: all[1], participant: all[2] });
  });
  ended.then((code) => failed(new Error(`study run ended (${code}): ${text}`)));
});

class Done extends Error {}

async function answer(page) {
  for (const [i, steps] of ANSWERS.entries()) {
    await page.evaluate((at) => (document.querySelectorAll(".item")[at].dataset.test = at), i);
    await tab_to(page, `[data-test="${i}"] *`);
    await page.keyboard.press("Home");
    for (let k = 0; k < steps; k++) await page.keyboard.press("ArrowRight");
  }
}

let has_operator = false;
async function look(screen, participant, operator, phase) {
  if (phase === "running" && !has_operator) {
    await until(
      operator,
      (count) =>
        document.body.dataset.phase !== "running" ||
        document.querySelectorAll('#events-list [data-state="happened"]').length >= count,
      WIDE_ENOUGH,
    );
    const run = operator.frames().find((frame) => frame.url().includes("show=trial"));
    await run?.waitForFunction(() => document.body.dataset.stale === "false").catch(() => {});
    const picture = await operator.screenshot();
    has_operator = await operator.evaluate(() => document.body.dataset.phase === "running");
    if (has_operator) writeFileSync(join(images, "study_operator.png"), picture);
  }
  if (screen === "form") {
    await answer(participant);
    await participant.screenshot({ path: join(images, "study_form.png") });
    throw new Done();
  }
}

const browser = await start_browser();
try {
  const operator = await open(browser, links.operator, { viewport: { width: 1280, height: 800 } });
  const participant = await open(browser, links.participant, { viewport: { width: 1100, height: 760 } });
  await drive(operator.page, participant.page, { trial_s: LONGEST_TRIAL_S, look }).catch((error) => {
    if (!(error instanceof Done)) throw error;
  });
} finally {
  await browser.close();
  child.kill("SIGINT");
  await ended;
  rmSync(folder, { recursive: true });
}
if (!has_operator) {
  console.error("the machine was too slow to draw a trial: again");
  process.exitCode = 1;
}
