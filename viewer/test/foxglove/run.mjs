// Opens the live interface in the last open Foxglove Studio (npm package @foxglove/studio-base) in
// a browser, with the layout of examples/foxglove, and uses it: device, twin and plots are drawn, and
// a parameter changed there is changed in the run.
//
//   node test/foxglove/run.mjs PROGRAM FOLDER [PICTURE]
//
// FOLDER takes the packages of the viewer (180 MB), once. Ends with 77 where they cannot be had.
import { spawnSync } from "node:child_process";
import { createServer } from "node:http";
import { existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, extname, join, normalize, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { MessageWriter } from "@foxglove/rosmsg2-serialization";

import { PATIENCE, start_browser, start_program } from "../browser/browser.mjs";
import { POSE, Tool, definitions, eventually, expect, result } from "../live/tool.mjs";

const PACKAGES = ["@foxglove/studio-base@1.48.0", "react@17.0.2", "react-dom@17.0.2"];
const TYPES = { ".html": "text/html", ".js": "text/javascript", ".json": "application/json",
  ".wasm": "application/wasm", ".png": "image/png", ".urdf": "application/xml" };
const LEAST_PICTURE = 60_000; // bytes: empty panels give less than half
const SETTING = "hinge.damping_Nms_per_rad";

const here = dirname(fileURLToPath(import.meta.url));
const root = resolve(here, "../../..");
const [program_path, folder, picture] = process.argv.slice(2);

function install_viewer() {
  if (existsSync(join(folder, "node_modules/@foxglove/studio-base/assets/index.js"))) return;
  mkdirSync(folder, { recursive: true });
  writeFileSync(join(folder, "package.json"), "{}");
  const options = ["install", "--no-audit", "--no-fund", "--ignore-scripts", "--legacy-peer-deps", "--save-exact"];
  const npm = spawnSync("npm", [...options, ...PACKAGES], { cwd: folder, stdio: "inherit" });
  if (npm.status === 0) return;
  console.log("skipped: the packages of the viewer cannot be installed");
  process.exit(77);
}

// Serves the viewer, the layout, and the URDF of the twin: this version of the viewer takes a second
// robot by address only.
function serve(files) {
  const modules = join(folder, "node_modules");
  const folders = { react: join(modules, "react"), "react-dom": join(modules, "react-dom"),
    studio: join(modules, "@foxglove/studio-base/assets") };
  const server = createServer((request, response) => {
    const path = normalize(decodeURIComponent(new URL(request.url, "http://x").pathname));
    const [, first, ...rest] = path.split("/");
    const content = files[path] ?? (folders[first] && existsSync(join(folders[first], ...rest))
      ? readFileSync(join(folders[first], ...rest)) : undefined);
    response.writeHead(content === undefined ? 404 : 200,
      { "Content-Type": TYPES[extname(path)] ?? "text/html", "Access-Control-Allow-Origin": "*" });
    response.end(content);
  });
  return new Promise((done) => server.listen(0, "127.0.0.1", () => done(server)));
}

// Leads the hand to and fro, so that there is something to see; the function that ends it.
function lead_hand(tool) {
  const channel = tool.client.advertise({ topic: "/hand_target", encoding: "cdr",
    schemaName: "geometry_msgs/msg/PoseStamped", schema: POSE, schemaEncoding: "ros2msg" });
  const writer = new MessageWriter(definitions(POSE));
  const handle = tool.newest.get("/tf").transforms.find((one) => one.child_frame_id === "handle");
  const { x, y, z } = handle.transform.translation;
  const begin = Date.now();
  const timer = setInterval(() => {
    const phase = (Date.now() - begin) / 1500;
    const position = { x: x - 0.25 * (1 - Math.cos(phase)), y: y - 0.2 * Math.sin(phase), z };
    tool.client.sendMessage(channel, writer.writeMessage({
      header: { stamp: { sec: 0, nanosec: 0 }, frame_id: "base" },
      pose: { position, orientation: { x: 0, y: 0, z: 0, w: 0 } },
    }));
  }, 30);
  return () => clearInterval(timer);
}

// The value in the panel of parameters is replaced and submitted, as a person does it.
async function change_parameter(page, tool) {
  const row = page.locator("tr", { hasText: SETTING });
  await row.first().waitFor();
  const field = row.first().locator("input, textarea").first();
  await field.scrollIntoViewIfNeeded();
  const [before] = await tool.parameters([SETTING], "before");
  expect(Number(await field.inputValue()) === before.value, `the panel shows ${SETTING} = ${before.value}`);
  const wanted = before.value + 7;
  await field.fill(String(wanted));
  await row.first().locator("button").first().click();
  let asked = 0;
  await eventually(async () => {
    asked += 1;
    return (await tool.parameters([SETTING], `after ${asked}`))[0].value === wanted;
  }, "the value of the panel in the run");
  const events = () => tool.events.find(({ name, text }) => name === "set" && text.includes(SETTING));
  const event = await eventually(events, "the event");
  expect(event.text.includes(String(wanted)), `the run took it: ${event.text}`);
}

install_viewer();
const recordings = mkdtempSync(join(tmpdir(), "hg_foxglove_"));
const program = await start_program([program_path, "run", "door", "--user", "mouse", "--no-browser",
  "--recordings", recordings, "--duration", "100000"]);
const browser = await start_browser();
try {
  const tool = new Tool(program.link, ["foxglove.websocket.v1"]);
  await tool.greeted();
  for (const topic of ["/tf", "/hapticgiant/events", "/hapticgiant/sample"]) tool.subscribe(topic);
  await eventually(() => tool.newest.get("/hapticgiant/sample")?.record.mode === 3, "the device runs");
  tool.client.fetchAsset("package://hapticgiant/twin.urdf", 1);
  const twin = new TextDecoder().decode((await eventually(() => tool.assets.get(1), "the URDF of the twin")).data);
  expect(twin.includes("twin/leaf"), "the URDF of the twin has its links");

  const files = { "/": readFileSync(join(here, "viewer.html")), "/twin.urdf": twin };
  const server = await serve(files);
  const origin = `http://127.0.0.1:${server.address().port}`;
  const layout = JSON.parse(readFileSync(join(root, "examples/foxglove/hapticgiant.json"), "utf8"));
  layout.configById["3D!scene"].layers.twin.url = `${origin}/twin.urdf`;
  files["/layout.json"] = JSON.stringify(layout);

  const context = await browser.newContext({ viewport: { width: 1280, height: 760 } });
  const page = await context.newPage();
  page.setDefaultTimeout(PATIENCE.timeout);
  const errors = [];
  page.on("pageerror", (error) => errors.push(String(error)));
  if (process.env.VERBOSE) page.on("console", (line) => console.log("   ", line.text().slice(0, 300)));
  const { host } = new URL(program.link);
  const live = `ws://${host}/live?token=${program.link.split("token=")[1]}`;
  const stop_hand = lead_hand(tool);
  await page.goto(`${origin}/?live=${encodeURIComponent(live)}`);
  await change_parameter(page, tool);
  await eventually(async () => (await page.locator("canvas").count()) >= 5, "the 3D view and four plots");
  await page.keyboard.press("["); // closes the bar at the left
  await page.waitForTimeout(12_000); // the plots fill
  const image = await page.screenshot({ path: picture });
  expect(image.length > LEAST_PICTURE, `a picture of ${image.length} bytes`);
  expect(errors.length === 0, `errors of the viewer: ${errors.join("; ") || "none"}`);
  stop_hand();
  tool.close();
  server.close();
} catch (error) {
  expect(false, String(error.stack));
}
await browser.close();
await program.stop();
rmSync(recordings, { recursive: true });
process.exit(result.failures === 0 ? 0 : 1);
