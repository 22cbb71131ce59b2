// Makes the pictures of the page in docs/images: door.png, own_arm.png and viewer_*.png.
//
//   npm run screenshots [-- PROGRAM [NAME...]]      default: ../build/release/hapticgiant, all
import { dirname, resolve } from "node:path";
import { fileURLToPath } from "node:url";

import {
  arc,
  comes_true,
  drag_along,
  drawn,
  frame_of,
  open_page,
  pictures,
  scene_of,
  start_browser,
  start_program,
} from "./browser.mjs";

const here = dirname(fileURLToPath(import.meta.url));
const root = resolve(here, "../../..");
const program = resolve(process.argv[2] ?? resolve(root, "build/release/hapticgiant"));
const laptop = { width: 1366, height: 768 };
const tablet = { width: 820, height: 1180 };

async function open_door(page, take) {
  const { p_B_H_m } = await frame_of(page);
  const { twin } = await scene_of(page);
  const angles = Array.from({ length: 11 }, (_, i) => 0.05 * (i + 1));
  await drag_along(page, arc(p_B_H_m, twin.p_B_root_m, angles), async () => {
    await comes_true(page, (f) => f.q_twin[0] > 0.4);
    await take();
  });
}

// Takes the picture when the run is older than `after_s` and the hand feels more than `force_N`,
// however slowly the machine draws: the script begins again, because it has played on while the page
// was opened, and the page itself pauses it.
async function take_when(page, take, { after_s = 0, force_N = 0, speed = "1" }) {
  const { run } = await frame_of(page);
  await page.keyboard.press("r");
  await comes_true(page, (f) => f.run !== run);
  await page.click("#pause"); // the view is chosen at the beginning
  await comes_true(page, (f) => f.run_state.is_paused);
  await drawn(page);
  await page.selectOption("#speed", speed);
  await page.click("#pause");
  await page.evaluate(pause_when, [after_s, force_N]);
  await comes_true(page, (f) => f.run_state.is_paused);
  await pictures(page);
  await take();
}

function pause_when([after_s, force_N]) {
  return new Promise((done) => {
    const timer = setInterval(() => {
      const { frame } = window.hapticgiant;
      if (frame.time_s < after_s || Math.hypot(...frame.force_N) < force_N) return;
      clearInterval(timer);
      document.querySelector("#pause").click();
      done();
    }, 20);
  });
}

const when = (moment) => (page, take) => take_when(page, take, moment);
const bucket_ends = when({ after_s: 9, force_N: 40, speed: "0.5" });

// The table that is touched, from nearer by.
async function touch_table(page, take) {
  const { x, y } = await page.evaluate(() => window.hapticgiant.handle_on_screen);
  await page.mouse.move(x, y - 100);
  for (let i = 0; i < 2; i++) await page.mouse.wheel(0, -120);
  await take_when(page, take, { force_N: 10 });
}

// While the person pulls, so that the arrow is seen; slowly, because that is soon over.
const pull = when({ force_N: 8, speed: "0.1" });

const PICTURES = [
  { name: "door", args: ["door", "--user", "mouse"], play: open_door },
  { name: "viewer_excavator", args: ["excavator"], plots: true, play: bucket_ends },
  { name: "viewer_free_space", args: ["free_space"], plots: true, play: when({ after_s: 21.2 }) },
  {
    name: "viewer_dark",
    args: ["door", "--user", "mouse"],
    dark: true,
    plots: true,
    play: open_door,
  },
  { name: "viewer_surfaces", args: ["surfaces"], play: touch_table },
  { name: "own_arm", args: ["ur10e/open_drawer"], play: pull },
  { name: "viewer_tablet", args: ["excavator"], viewport: tablet, play: bucket_ends },
];

// A busy machine may have no data for a moment: not in a picture.
async function take_fresh(page, path) {
  const is_stale = () => page.evaluate(() => document.body.dataset.stale === "true");
  for (let is_fresh = false; !is_fresh;) {
    await page.waitForFunction(() => document.body.dataset.stale === "false");
    await page.screenshot({ path });
    is_fresh = !(await is_stale());
  }
}

// Who knows the page needs no first steps.
const known = (page) =>
  page.addInitScript(() => localStorage.setItem("hapticgiant.guide", "dismissed"));

const LONG = ["--duration", "3600"]; // the program waits when the script has played

const wanted = process.argv.slice(3);
const browser = await start_browser();
for (const { name, args, viewport = laptop, dark, plots, play } of PICTURES) {
  if (wanted.length > 0 && !wanted.includes(name)) continue;
  const running = await start_program([program, "run", ...args, ...LONG, "--no-recording"]);
  const options = { viewport, colorScheme: dark ? "dark" : "light" };
  const { page, close } = await open_page(browser, `${running.link}&quality=best`, options, known);
  if (plots) await page.click("#show-plots");
  const path = resolve(root, `docs/images/${name}.png`);
  await play(page, () => take_fresh(page, path));
  console.log(path);
  await close();
  await running.stop();
}
await browser.close();
