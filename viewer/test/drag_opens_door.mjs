// Opens the page of a running program in a browser and opens the door with the mouse.
//
//   node test/drag_opens_door.mjs PROGRAM [ARGS...]
//
// The program prints the link of its page. Without a program: the demonstration server of
// hg/viewer_server/test. Environment: CHROMIUM (default /usr/bin/chromium), HG_BUILD (build folder
// of the demonstration server), SCREENSHOT (default test/output/drag_opens_door.png).
import { drag_along, hide_and_compare, open_page, start_program } from "./browser.mjs";
import { mkdirSync } from "node:fs";
import { dirname, resolve } from "node:path";
import { fileURLToPath } from "node:url";

const SMALLEST_OPENING = 0.5; // rad
const SMALLEST_RATE = 20; // frames/s
const SMALLEST_DEVICE = 3000; // pixels of 1366 x 768 that the device changes

const here = dirname(fileURLToPath(import.meta.url));
const root = resolve(here, "../..");
const demo = [
  resolve(root, process.env.HG_BUILD ?? "build/release", "viewer_server_demo"),
  resolve(root, "viewer/dist"),
  resolve(root, "models/haptic_giant/haptic_giant.urdf"),
  resolve(root, "models/twins/door/door.urdf"),
];

let failures = 0;
function expect(is_true, text) {
  console.log(`${is_true ? "ok    " : "FAILED"} ${text}`);
  if (!is_true) failures += 1;
}

// Frames in the best of the first seconds: drawing in software halts the page now and then.
async function best_rate(page) {
  let best = 0;
  for (let i = 0; i < 60 && best < SMALLEST_RATE; i++) {
    await page.waitForTimeout(500);
    best = Math.max(best, await page.evaluate(() => window.hapticgiant.frames_per_second));
  }
  return best;
}

// Points on the arc of the handle about the hinge, by `angles` from where the handle is.
function arc(handle, hinge, angles) {
  const [x, y] = [handle[0] - hinge[0], handle[1] - hinge[1]];
  return angles.map((a) => [
    hinge[0] + x * Math.cos(a) - y * Math.sin(a),
    hinge[1] + x * Math.sin(a) + y * Math.cos(a),
    handle[2],
  ]);
}

const command = process.argv.length > 2 ? process.argv.slice(2) : demo;
const program = await start_program(command);
let close = () => {};
try {
  const opened = await open_page(program.link);
  const { page, problems } = opened;
  close = opened.close;
  await page.waitForFunction(() => window.hapticgiant?.frame, null, { timeout: 30_000 });
  const rate = await best_rate(page);
  expect(rate >= SMALLEST_RATE, `${rate} frames per second arrive (at least ${SMALLEST_RATE})`);

  const pixels = await hide_and_compare(page, "#show-device");
  expect(pixels >= SMALLEST_DEVICE, `the device covers ${pixels} pixels`);

  const { handle, twin, hinge } = await page.evaluate(() => ({
    handle: window.hapticgiant.frame.p_B_H_m,
    twin: window.hapticgiant.scene.twin,
    hinge: window.hapticgiant.frame.q_twin[0],
  }));
  expect(Math.abs(hinge) < 0.05, `the door is closed at first: ${hinge} rad`);

  const angles = Array.from({ length: 25 }, (_, i) => 0.05 * (i + 1));
  let widest = 0;
  await drag_along(page, arc(handle, twin.p_B_root_m, angles), async () => {
    widest = await page.evaluate(() => window.hapticgiant.frame.q_twin[0]);
    mkdirSync(resolve(here, "output"), { recursive: true });
    const file = process.env.SCREENSHOT ?? resolve(here, "output/drag_opens_door.png");
    await page.screenshot({ path: file });
  });
  expect(widest > SMALLEST_OPENING, `dragging has opened the door to ${widest} rad`);
  expect(problems.length === 0, `no errors or foreign requests: ${problems.join("; ") || "none"}`);
} catch (error) {
  expect(false, String(error));
} finally {
  await close();
  await program.stop();
}
process.exit(failures === 0 ? 0 : 1);
