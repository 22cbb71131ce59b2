// Helpers of the browser tests: the program, a headless Chromium, the mouse, pictures.
import { spawn } from "node:child_process";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { chromium } from "playwright-core";

const FLAGS = [
  "--disable-background-networking",
  "--disable-component-update",
  "--disable-quic",
  "--disable-sync",
  "--no-first-run",
];
const SPACE = ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]; // without graphics hardware
export const NO_SPACE = ["--disable-gpu", "--disable-webgl", "--disable-3d-apis"];
export const PATIENCE = { timeout: 180_000 }; // a machine may be slow; nothing is timed

// Starts `command` and waits for the link of its page.
export function start_program(command) {
  const program = spawn(command[0], command.slice(1), { stdio: ["ignore", "pipe", "inherit"] });
  const stop = () =>
    new Promise((done) => {
      if (program.exitCode !== null || program.signalCode !== null) return done();
      program.once("exit", done);
      program.kill("SIGINT");
      setTimeout(() => program.kill("SIGKILL"), 5000).unref();
    });
  return new Promise((found, failed) => {
    let output = "";
    program.stdout.on("data", (text) => {
      output += text;
      const link = /http:\/\/127\.0\.0\.1:\d+\/#token=[0-9a-f]+/.exec(output);
      if (link) found({ link: link[0], stop });
    });
    program.once("error", failed);
    program.once("exit", (code) => failed(new Error(`${command[0]} ended (${code}): ${output}`)));
  });
}

// `graphics`: WebGL, or NO_SPACE for none.
export function start_browser(graphics = SPACE) {
  const is_root = process.getuid?.() === 0;
  return chromium.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    args: [...FLAGS, ...graphics, ...(is_root ? ["--no-sandbox"] : [])],
  });
}

const VIEWPORT = { width: 1000, height: 600 }; // small: it is drawn without graphics hardware

// Opens `link`, after `prepare`, and waits until the scene is drawn; `problems` collects errors of
// the page and requests to other machines.
export async function open_page(browser, link, options = {}, prepare = async () => {}) {
  const context = await browser.newContext({ viewport: VIEWPORT, ...options });
  const page = await context.newPage();
  page.setDefaultTimeout(PATIENCE.timeout);
  const problems = [];
  page.on("pageerror", (error) => problems.push(String(error)));
  page.on("console", (line) => line.type() === "error" && problems.push(line.text()));
  page.on("request", (request) => {
    const is_own =
      request.url().startsWith(new URL(link).origin) || /^(blob|data):/.test(request.url());
    if (!is_own) problems.push(request.url());
  });
  await prepare(page);
  await page.goto(link, { ...PATIENCE, waitUntil: "commit" });
  await drawn(page);
  return { page, problems, close: () => context.close() };
}

// Waits until the scene is drawn and the camera rests.
export async function drawn(page) {
  await page.waitForFunction(
    () =>
      window.hapticgiant?.is_connected && window.hapticgiant.is_drawn && window.hapticgiant.frame,
    null,
    PATIENCE,
  );
  const corner = () => page.evaluate(() => window.hapticgiant.on_screen([0, 0, 0]));
  let last = null;
  for (const end = Date.now() + PATIENCE.timeout; Date.now() < end;) {
    await pictures(page);
    const now = await corner();
    if (last && Math.hypot(now.x - last.x, now.y - last.y) < 0.5) return;
    last = now;
  }
  throw new Error("the camera does not come to rest");
}

// The link of a page that is drawn as cheaply as it can be.
export function cheap(link) {
  return `${link}&quality=fast`;
}

// Waits until the present data of the page has been drawn.
export async function pictures(page) {
  await page.evaluate(async () => {
    for (let i = 0; i < 3; i++) await new Promise(requestAnimationFrame);
  });
}

// Whether the page comes to `test(argument)`.
export function page_comes_to(page, test, argument = null) {
  return page.waitForFunction(test, argument, PATIENCE).then(
    () => true,
    () => false,
  );
}

export function frame_of(page) {
  return page.evaluate(() => window.hapticgiant.frame);
}

export function scene_of(page) {
  return page.evaluate(() => window.hapticgiant.scene);
}

// Waits until `test(frame)` holds; false when it does not come.
export async function comes_true(page, test, patience_ms = PATIENCE.timeout) {
  for (const end = Date.now() + patience_ms; Date.now() < end;) {
    const frame = await frame_of(page);
    if (frame && test(frame)) return true;
    await page.waitForTimeout(50);
  }
  return false;
}

// Waits until the run is `duration_s` older.
export async function lives(page, duration_s) {
  const { time_s } = await frame_of(page);
  await comes_true(page, (f) => f.time_s >= time_s + duration_s);
}

// Grabs the handle, moves the mouse over the points (in B), and lets go after `at_end`.
export async function drag_along(page, points, at_end) {
  const start = await page.evaluate(() => window.hapticgiant.handle_on_screen);
  await page.mouse.move(start.x, start.y);
  await page.mouse.down();
  await comes_true(page, (f) => f.hand.active);
  await lives(page, 0.6); // the lever goes down first
  for (const point of points) {
    const { x, y } = await page.evaluate((p) => window.hapticgiant.on_screen(p), point);
    await page.mouse.move(x, y);
    await lives(page, 0.06);
  }
  await at_end();
  await page.mouse.up();
}

// Points on the arc of the handle about the hinge, by `angles` from where the handle is.
export function arc(handle, hinge, angles) {
  const [x, y] = [handle[0] - hinge[0], handle[1] - hinge[1]];
  return angles.map((a) => [
    hinge[0] + x * Math.cos(a) - y * Math.sin(a),
    hinge[1] + x * Math.sin(a) + y * Math.cos(a),
    handle[2],
  ]);
}

// Number of pixels of the scene that change when `layer` is switched off, and come back with it; what
// moves on its own does not count.
export async function hide_and_compare(page, layer, place = null) {
  const { x, y, width, height } = await page.locator("#stage").boundingBox();
  const clip = place ?? { x, y: y + 70, width, height: height - 140 }; // without what lies over it
  const take = async () => {
    await pictures(page);
    return (await page.screenshot({ clip })).toString("base64");
  };
  const shown = await take();
  const box = page.locator(`#show-${layer}`); // its menu is shut, so that it is not in the pictures
  await box.evaluate((found) => found.click());
  const hidden = await take();
  await box.evaluate((found) => found.click());
  const again = await take();
  return page.evaluate(count_different, [shown, hidden, again]);
}

export async function count_different(pictures) {
  const [shown, hidden, again] = await Promise.all(
    pictures.map(async (base64) => {
      const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
      const bitmap = await createImageBitmap(new Blob([bytes], { type: "image/png" }));
      const context = new OffscreenCanvas(bitmap.width, bitmap.height).getContext("2d");
      context.drawImage(bitmap, 0, 0);
      return context.getImageData(0, 0, bitmap.width, bitmap.height).data;
    }),
  );
  let count = 0;
  const differ = (a, b, i) =>
    [0, 1, 2].reduce((sum, c) => sum + Math.abs(a[i + c] - b[i + c]), 0) > 30;
  for (let i = 0; i < shown.length; i += 4) {
    if (differ(shown, hidden, i) && differ(again, hidden, i) && !differ(shown, again, i)) count += 1;
  }
  return count;
}

// Puts an emulated headset into the page before it loads; the page's script gets `xr_device`.
export async function wear_headset(page) {
  const file = createRequire(import.meta.url).resolve("iwer/build/iwer.min.js");
  await page.addInitScript(readFileSync(file, "utf8"));
  await page.addInitScript(() => {
    window.xr_device = new window.IWER.XRDevice(window.IWER.metaQuest3);
    window.xr_device.installRuntime({ forceInstall: true });
  });
}
