// The first view of shipped scenes: device, twin, handle and force are in the picture, and nothing
// hides what the hand holds.
//
//   node test/browser/first_views.mjs PROGRAM [SCENARIO...]
import { cheap, comes_true, drawn, frame_of, hide_and_compare, open_page, scene_of, start_browser, start_program } from "./browser.mjs";

const SCENARIOS = [
  "door",
  "excavator",
  "free_space",
  "surfaces",
  "path",
  "ur5e/open_cupboard",
  "fr3/move_tool",
  "xarm7/open_drawer",
  "ur10e/open_drawer",
  "remote_arm",
  "teleoperation",
];
const UPRIGHT = { width: 390, height: 844 };
const ARROW = 0.2; // m
const BESIDE = 30; // px around the handle
const SMALLEST = { device: 4000, twin: 1500, remote: 1500 }; // pixels seen
const SMALLEST_AT_HANDLE = 150; // pixels of the device beside the handle

let failures = 0;
function expect(is_true, text) {
  console.log(`${is_true ? "ok    " : "FAILED"} ${text}`);
  if (!is_true) failures += 1;
}

async function still(page) {
  await page.click("#pause");
  await comes_true(page, (f) => f.run_state.is_paused);
}

async function all_in_picture(page, name) {
  const [{ twin, teleoperation }, frame] = [await scene_of(page), await frame_of(page)];
  const along = frame.force_N.map((part) => (ARROW * part) / Math.max(1, Math.hypot(...frame.force_N)));
  const places = {
    handle: frame.p_B_H_m,
    "end of the device": frame.p_B_E_m,
    elbow: frame.p_B_elbow_m,
    "tip of the force": frame.p_B_H_m.map((x, i) => x + along[i]),
    ...(teleoperation && { "the remote machine": teleoperation.p_B_root_m }),
    twin: twin.joints.some(({ type }) => type === "floating") ? frame.p_B_H_m : twin.p_B_root_m,
  };
  const stage = await page.locator("#stage").boundingBox();
  for (const [what, p_B] of Object.entries(places)) {
    const { x, y } = await page.evaluate((p) => window.hapticgiant.on_screen(p), p_B);
    const is_in = x > stage.x && x < stage.x + stage.width && y > stage.y && y < stage.y + stage.height;
    expect(is_in, `${name}: ${what} is in the picture`);
  }
}

async function all_seen(page, name) {
  const { teleoperation } = await scene_of(page);
  for (const [layer, smallest] of Object.entries(SMALLEST)) {
    if (layer === "remote" && teleoperation === null) continue;
    const count = await hide_and_compare(page, layer);
    expect(count >= smallest, `${name}: ${count} pixels of the ${layer} are seen`);
  }
  const { x, y } = await page.evaluate(() => window.hapticgiant.handle_on_screen);
  const clip = { x: x - BESIDE, y: y - BESIDE, width: 2 * BESIDE, height: 2 * BESIDE };
  const count = await hide_and_compare(page, "device", clip);
  expect(count >= SMALLEST_AT_HANDLE, `${name}: ${count} pixels of it beside the handle`);
}

const [program, ...wanted] = process.argv.slice(2);
const browser = await start_browser();
for (const scenario of wanted.length > 0 ? wanted : SCENARIOS) {
  const running = await start_program([program, "run", scenario, "--duration", "3600", "--no-recording"]);
  const { page, close } = await open_page(browser, cheap(running.link));
  await still(page);
  await all_in_picture(page, scenario);
  await all_seen(page, scenario);
  await page.setViewportSize(UPRIGHT);
  await drawn(page);
  await all_in_picture(page, `${scenario}, upright`);
  await close();
  await running.stop();
}
await browser.close();
process.exit(failures === 0 ? 0 : 1);
