// Helpers of the browser tests: the program, a headless Chromium, the mouse, pictures.
import { spawn } from "node:child_process";
import { chromium } from "playwright-core";

const FLAGS = [
  "--disable-background-networking",
  "--disable-component-update",
  "--disable-quic",
  "--disable-sync",
  "--no-first-run",
  "--use-gl=angle",
  "--use-angle=swiftshader", // WebGL without graphics hardware
  "--enable-unsafe-swiftshader",
];

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
      const link = /http:\/\/127\.0\.0\.1:\d+\/\?token=[0-9a-f]+/.exec(output);
      if (link) found({ link: link[0], stop });
    });
    program.once("error", failed);
    program.once("exit", (code) => failed(new Error(`${command[0]} ended (${code}): ${output}`)));
  });
}

// Opens `link`, after `prepare`; `problems` collects errors of the page and requests to other
// machines.
export async function open_page(link, options = {}, prepare = async () => {}) {
  const is_root = process.getuid?.() === 0;
  const browser = await chromium.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    args: is_root ? [...FLAGS, "--no-sandbox"] : FLAGS,
  });
  const page = await browser.newPage({ viewport: { width: 1366, height: 768 }, ...options });
  const problems = [];
  page.on("pageerror", (error) => problems.push(String(error)));
  page.on("console", (line) => line.type() === "error" && problems.push(line.text()));
  page.on("request", (request) => {
    if (!request.url().startsWith(new URL(link).origin)) problems.push(request.url());
  });
  await prepare(page);
  await page.goto(link);
  return { page, problems, close: () => browser.close() };
}

// Grabs the handle, moves the mouse over the points (in B), and lets go after `at_end`.
export async function drag_along(page, points, at_end) {
  const start = await page.evaluate(() => window.hapticgiant.handle_on_screen);
  await page.mouse.move(start.x, start.y);
  await page.mouse.down();
  await page.waitForTimeout(600); // the lever goes down first
  for (const point of points) {
    const { x, y } = await page.evaluate((p) => window.hapticgiant.on_screen(p), point);
    await page.mouse.move(x, y);
    await page.waitForTimeout(80);
  }
  await page.waitForTimeout(800);
  await at_end();
  await page.mouse.up();
}

// Number of pixels of the scene that change when `check_box` is switched off (and on again).
export async function hide_and_compare(page, check_box) {
  const clip = { x: 0, y: 100, width: 1060, height: 560 }; // without the panels
  const shown = await page.screenshot({ clip });
  await page.uncheck(check_box);
  await page.waitForTimeout(500);
  const hidden = await page.screenshot({ clip });
  await page.check(check_box);
  return page.evaluate(count_different, [shown.toString("base64"), hidden.toString("base64")]);
}

async function count_different(pictures) {
  const [a, b] = await Promise.all(
    pictures.map(async (base64) => {
      const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
      const bitmap = await createImageBitmap(new Blob([bytes], { type: "image/png" }));
      const context = new OffscreenCanvas(bitmap.width, bitmap.height).getContext("2d");
      context.drawImage(bitmap, 0, 0);
      return context.getImageData(0, 0, bitmap.width, bitmap.height).data;
    }),
  );
  let count = 0;
  for (let i = 0; i < a.length; i += 4) {
    const change = [0, 1, 2].reduce((sum, c) => sum + Math.abs(a[i + c] - b[i + c]), 0);
    if (change > 30) count += 1;
  }
  return count;
}
