// Opens the page of a running program in a browser and uses it as people do.
//
//   node test/browser/run.mjs [--case NAME]... PROGRAM [ARGS...]
//
// The program prints the link of its page; each case has its own run of it. Without a program: the
// demonstration server of hg/viewer_server/test. Environment: CHROMIUM (default /usr/bin/chromium),
// HG_BUILD (build folder of the demonstration server).
import { dirname, resolve } from "node:path";
import { fileURLToPath } from "node:url";

import { start_browser, start_program } from "./browser.mjs";
import * as cases from "./cases.mjs";
import * as everyone from "./everyone_cases.mjs";
import * as guide from "./guide_cases.mjs";
import * as headset from "./headset_cases.mjs";
import * as moving_base from "./moving_base_cases.mjs";
import * as teleoperation from "./teleoperation_cases.mjs";

const here = dirname(fileURLToPath(import.meta.url));
const root = resolve(here, "../../..");
const demo = [
  resolve(root, process.env.HG_BUILD ?? "build/release", "viewer_server_demo"),
  resolve(root, "viewer/dist"),
  resolve(root, "models/haptic_giant/haptic_giant.urdf"),
  resolve(root, "models/twins/door/door.urdf"),
];

const wanted = [];
const rest = process.argv.slice(2);
while (rest[0] === "--case") wanted.push(...rest.splice(0, 2).slice(1));
const command = rest.length > 0 ? rest : demo;

let failures = 0;
function expect(is_true, text) {
  console.log(`${is_true ? "ok    " : "FAILED"} ${text}`);
  if (!is_true) failures += 1;
}

const browser = await start_browser();
const stopping = [];
for (const [name, run] of Object.entries({ ...cases, ...everyone, ...guide, ...headset, ...moving_base, ...teleoperation })) {
  if (wanted.length > 0 && !wanted.includes(name)) continue;
  console.log(`-- ${name.replaceAll("_", " ")}`);
  const program = await start_program(command);
  try {
    await run({ browser, program, command, expect });
  } catch (error) {
    expect(false, String(error));
  }
  for (const context of browser.contexts()) await context.close();
  stopping.push(program.stop());
}
await Promise.all(stopping);
await browser.close();
process.exit(failures === 0 ? 0 : 1);
