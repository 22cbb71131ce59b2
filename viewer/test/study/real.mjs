// A whole study with the real program, by keys alone: two people, one in English and one in German,
// then the report. The scripted hand plays the trials.
//
//   node test/study/real.mjs PROGRAM
import { spawn, spawnSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { drive, open, press, start_browser, until } from "./keyboard.mjs";

const program = resolve(process.argv[2]);
const study = fileURLToPath(new URL("two_hinges.yaml", import.meta.url));
const folder = join(mkdtempSync(join(tmpdir(), "study_")), "out");
const LONGEST_TRIAL_S = 60; // they end by themselves

let failures = 0;
function expect(is_true, text) {
  console.log(`${is_true ? "ok    " : "FAILED"} ${text}`);
  if (!is_true) failures += 1;
}

function start() {
  const words = ["study", "run", study, "--rehearse", "--no-browser", "--out", folder];
  const child = spawn(program, words, { stdio: ["ignore", "pipe", "inherit"] });
  const ended = new Promise((done) => child.once("exit", done));
  return new Promise((found, failed) => {
    let text = "";
    child.stdout.on("data", (part) => {
      text += part;
      const links = /operator +(\S+)\s+participant +(\S+)/.exec(text);
      if (links) found({ operator: links[1], participant: links[2], child, ended });
    });
    ended.then((code) => failed(new Error(`study run ended (${code}): ${text}`)));
  });
}

const table = (name) => readFileSync(join(folder, `${name}.csv`), "utf8").trim().split("\n").slice(1);

const running = await start();
const browser = await start_browser();
try {
  const operator = await open(browser, running.operator);
  const participant = await open(browser, running.participant);
  for (const language of ["en", "de"]) {
    const screens = new Set();
    const look = async (screen) => void screens.add(screen);
    const visited = await drive(operator.page, participant.page, { trial_s: LONGEST_TRIAL_S, language, look });
    expect(true, `${visited.at(-1).code} is complete, in ${language}: ${[...screens].join(", ")}`);
    expect(!visited.some(({ phase }) => phase === "failed"), "every trial had a result");
    const text = await participant.page.textContent("body");
    expect(text.includes(language === "de" ? "Vielen Dank" : "Thank you"), "the last words are in this language");
    await press(operator.page, "#do-leave");
    await until(operator.page, () => document.body.dataset.phase === "closed");
  }
  for (const { problems } of [operator, participant]) {
    expect(problems.length === 0, `no errors or foreign requests: ${problems.join("; ") || "none"}`);
  }
} catch (error) {
  expect(false, String(error));
}
await browser.close();
running.child.kill("SIGINT");
expect((await running.ended) === 0, "the program ends as it should");

expect(table("trials").length === 4, "four trials, none of practice");
const values = table("answers").filter((row) => /,(tlx|impression|sus),/.test(row));
expect(values.length === 2 * (2 * (6 + 15 + 2 + 3) + 11), `all answers and scores: ${values.length}`);
const report = spawnSync(program, ["study", "report", study, "--out", folder], { encoding: "utf8" });
expect(report.status === 0, `the report is written ${report.stderr}`);
expect(existsSync(join(folder, "report.html")), "and is there");
rmSync(join(folder, ".."), { recursive: true });
process.exit(failures === 0 ? 0 : 1);
