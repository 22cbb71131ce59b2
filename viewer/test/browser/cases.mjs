// What the page does, in a browser, with the program. Each case gets {browser, program, command,
// expect}; none depends on how fast the machine is.
import { spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

import {
  PATIENCE,
  arc,
  cheap,
  comes_true,
  drag_along,
  drawn,
  frame_of,
  hide_and_compare,
  open_page,
  page_comes_to,
  pictures,
  scene_of,
  start_program,
} from "./browser.mjs";

const SMALLEST_DEVICE = 3000; // pixels that the device covers
const SMALLEST_GHOST = 3000;
const OPEN = 0.5; // rad
const HASTE_MS = 60_000; // within a minute
const DOOR_OPEN = "11.5"; // s, when the script has opened the door

export async function page_is_live({ browser, program, expect }) {
  const { page, problems, close } = await open_page(browser, program.link);
  const pixels = await hide_and_compare(page, "device");
  expect(pixels >= SMALLEST_DEVICE, `the device covers ${pixels} pixels`);
  const hint = await page.isVisible("#grip-text");
  expect(hint, "a hint at the handle says what to do");

  // tools/page_timing.py measures how many the program sends; a busy machine draws fewer
  const count = () =>
    page.evaluate(() => [window.hapticgiant.frames, window.hapticgiant.frame.time_s]);
  const [frames, time] = await count();
  const is_running = await comes_true(page, (f) => f.time_s > time + 1);
  const [later_frames, later_time] = await count();
  const rate = (later_frames - frames) / (later_time - time);
  const is_live = is_running && later_frames > frames;
  expect(is_live, `frames arrive, ${rate.toFixed(1)} for each second of the program`);
  expect(problems.length === 0, `no errors or foreign requests: ${problems.join("; ") || "none"}`);
  await close();
}

export async function drag_opens_door({ browser, program, expect }) {
  const { page, problems, close } = await open_page(browser, cheap(program.link));
  const frame = await frame_of(page);
  const { twin } = await scene_of(page);
  expect(Math.abs(frame.q_twin[0]) < 0.05, `the door is closed at first: ${frame.q_twin[0]} rad`);
  const angles = Array.from({ length: 25 }, (_, i) => 0.05 * (i + 1));
  await drag_along(page, arc(frame.p_B_H_m, twin.p_B_root_m, angles), async () => {
    const opens = await comes_true(page, (f) => f.q_twin[0] > OPEN);
    const { q_twin } = await frame_of(page);
    expect(opens, `dragging opens the door: ${q_twin[0]} rad`);
  });
  await page.waitForSelector("#grip-text", { state: "hidden", ...PATIENCE });
  expect(true, "the hint goes after the first drag");
  expect(await comes_true(page, (f) => !f.hand.active), "the hand lets go");
  expect(problems.length === 0, `no errors or foreign requests: ${problems.join("; ") || "none"}`);
  await close();
}

// As the page of a study shows it inside itself to who holds the handle.
export async function hand_alone({ browser, program, expect }) {
  const { page, problems, close } = await open_page(browser, cheap(`${program.link}&show=hand`));
  const seen = await page.evaluate(() =>
    ["emergency-stop", "hand", "view", "panel", "transport", "vitals", "scenario-field", "show-plots"].filter((id) =>
      document.getElementById(id).checkVisibility(),
    ),
  );
  expect(seen.join(" ") === "emergency-stop hand view", `only the stop, the hand and the camera: ${seen.join(" ")}`);
  await page.keyboard.press("p");
  const { time_s } = await frame_of(page);
  const still_runs = await comes_true(page, (f) => f.time_s > time_s + 0.5 && !f.run_state.is_paused);
  expect(still_runs, "no key pauses it");
  await page.keyboard.press("Escape");
  expect(await comes_true(page, (f) => f.safety.emergency_stop), "but Esc stops it");
  expect(problems.length === 0, `no errors or foreign requests: ${problems.join("; ") || "none"}`);
  await close();
  const trial = await open_page(browser, cheap(`${program.link}&show=trial`));
  const shown = await trial.page.evaluate(() =>
    ["emergency-stop", "panel", "vitals", "transport", "scenario-field", "hand", "grip"].filter((id) =>
      document.getElementById(id).checkVisibility(),
    ),
  );
  expect(shown.join(" ") === "emergency-stop panel vitals", `a trial without scenario, time and hand: ${shown.join(" ")}`);
  await trial.close();
}

// The operator of a study must not disturb who holds the handle.
export async function a_trial_does_not_ask_for_the_hand({ browser, program, expect }) {
  const hand = await open_page(browser, cheap(`${program.link}&show=hand`));
  const trial = await open_page(browser, cheap(`${program.link}&show=trial`));
  await hand.page.keyboard.down("d");
  const is_known = await page_comes_to(trial.page, () => /has the hand/.test(document.querySelector("#holder").textContent));
  expect(is_known, "the participant has the hand");
  const asks = ["#holder", "#ask-for-hand"];
  const seen = await trial.page.evaluate((parts) => parts.filter((part) => document.querySelector(part).checkVisibility()), asks);
  expect(seen.length === 0, `the operator's page does not offer to ask for it: ${seen.join(" ") || "nothing"}`);
  for (const key of "wasd") await trial.page.keyboard.press(key);
  const notices = await trial.page.textContent("#notices");
  expect(!/hand/.test(notices), `nor do keys that push say so: ${notices || "nothing"}`);
  await hand.page.keyboard.up("d");
  await hand.close();
  await trial.close();
}

// As a user without instructions does: at once, and not along the arc of the handle.
export async function hasty_drag_opens_door({ browser, program, expect }) {
  const { page, close } = await open_page(browser, cheap(program.link));
  if (!(await follows(page, "panel"))) return close(); // a fake door has no lever
  const { x, y } = await page.evaluate(() => window.hapticgiant.handle_on_screen);
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x, y - 60, { steps: 5 });
  const opens = await comes_true(page, (f) => f.q_twin[0] > 0.1, HASTE_MS);
  const [hinge, lever] = (await frame_of(page)).q_twin;
  expect(opens, `the lever goes down (${lever} rad) although it is pulled, and it opens: ${hinge} rad`);
  await page.mouse.up();
  await close();
}

export async function two_pages_share_a_run({ browser, program, expect }) {
  const first = await open_page(browser, cheap(program.link));
  const second = await open_page(browser, cheap(program.link));
  expect(await comes_true(first.page, (f) => f.clients >= 2), "both pages are counted");
  const start = await first.page.evaluate(() => window.hapticgiant.handle_on_screen);
  await first.page.mouse.move(start.x, start.y);
  await first.page.mouse.down();
  await first.page.mouse.move(start.x + 30, start.y - 10);
  expect(
    await comes_true(second.page, (f) => f.hand.active),
    "the second sees the first one's hand",
  );
  await first.page.mouse.up();
  expect(await comes_true(second.page, (f) => !f.hand.active), "and that it lets go");
  await first.close();
  expect(await comes_true(second.page, (f) => f.clients === 1), "the second stays alone");
  await second.close();
}

export async function unreadable_messages_are_noted({ browser, program, expect }) {
  let to_page = null;
  const { page, close } = await open_page(browser, cheap(program.link), {}, async (opened) => {
    await opened.routeWebSocket(/\/ws/, (socket) => {
      to_page = socket;
      const server = socket.connectToServer();
      server.onMessage((text) => socket.send(text));
    });
  });
  for (const text of ["{", '{"type":"frame"}', '{"type":"toString"}', "[]", "null"])
    to_page.send(text);
  const noted = await page_comes_to(page, () => window.hapticgiant.unreadable === 5);
  expect(noted, "messages that cannot be read are counted");
  const note = await page.textContent("#notices");
  expect(/could not be read/.test(note), `and noted: ${note}`);
  const { time_s } = await frame_of(page);
  expect(await comes_true(page, (f) => f.time_s > time_s), "frames continue");
  await close();
}

export async function connection_comes_back({ browser, program, expect }) {
  let cut = null;
  let connections = 0;
  const { page, close } = await open_page(browser, cheap(program.link), {}, async (opened) => {
    await opened.routeWebSocket(/\/ws/, (socket) => {
      connections += 1;
      const server = socket.connectToServer();
      cut = () => Promise.all([socket.close(), server.close()]);
    });
  });
  // it may be back before it is looked at
  await page.evaluate(() => {
    window.was_lost = false;
    new MutationObserver(() => {
      window.was_lost ||= document.body.dataset.connected === "false";
    }).observe(document.body, { attributeFilter: ["data-connected"] });
  });
  await cut();
  const lost = await page_comes_to(page, () => window.was_lost);
  expect(lost, "the page says that the connection is lost");
  await drawn(page);
  expect(connections >= 2, `it comes back automatically (${connections} connections)`);
  const { time_s } = await frame_of(page);
  expect(await comes_true(page, (f) => f.time_s > time_s), "frames continue");
  await close();
}

// The demonstration server follows no commands.
async function follows(page, command) {
  return (await scene_of(page)).commands.includes(command);
}

export async function changes_reach_the_program({ browser, program, expect }) {
  const first = await open_page(browser, cheap(program.link));
  if (!(await follows(first.page, "set"))) return first.close();
  const second = await open_page(browser, cheap(program.link));
  const { name, value, max } = (await scene_of(first.page)).settings.find((s) => s.value > 0);
  const box = `[data-setting="${name}"]`;
  const wanted = String(Number((0.5 * value).toPrecision(3)));
  await first.page.click("#tab-change");
  await second.page.click("#tab-change");
  await first.page.fill(box, wanted);
  await first.page.press(box, "Enter");
  const has_value = ([field, text]) => document.querySelector(field).value === text;
  const arrives = await page_comes_to(second.page, has_value, [box, wanted]);
  expect(arrives, `${name} = ${wanted} reaches the program and comes back to another page`);

  await second.page.reload(PATIENCE);
  await drawn(second.page);
  const known = await second.page.inputValue(box);
  expect(known === wanted, `a page that is opened later has it: ${known}`);

  await first.page.fill(box, String(10 * max + 1));
  await first.page.press(box, "Enter");
  const note = await first.page.locator(".setting .problem:visible").first().textContent();
  expect(/is expected/.test(note), `out of range is refused: ${note}`);
  const kept = await first.page.inputValue(box);
  expect(kept === String(10 * max + 1), `and stays in the box to be corrected: ${kept}`);
  await first.page.fill(box, String(10 * max + 2));
  await first.page.press(box, "Enter");
  const still = await first.page.getAttribute(box, "aria-invalid");
  expect(still === "true", "another one that is out of range is refused, too");
  await first.page.getByRole("button", { name: `keep ${wanted}`, exact: true }).click();
  expect((await first.page.inputValue(box)) === wanted, "it is put back by its button");
  await undo_reset_save({ page: first.page, box, wanted, value, expect });
  await first.close();
  await second.close();
}

export async function device_and_surfaces_are_chosen({ browser, program, expect }) {
  const { page, problems, close } = await open_page(browser, cheap(program.link));
  if (!(await follows(page, "device"))) return close();
  await page.click("#tab-change");
  const before = await frame_of(page);
  await page.selectOption("#choose-device", "fr3");
  const problem = "#choose-device-problem";
  await page.locator(problem).waitFor();
  const reason = await page.textContent(problem);
  expect(/^The Franka FR3 cannot hold the handle of the door/.test(reason), `it is refused below: ${reason}`);
  expect((await page.inputValue("#choose-device")) === "", "the choice is put back");
  const lives_on = await comes_true(page, (f) => f.time_s > before.time_s + 0.3 && f.mode === "running");
  expect(lives_on && (await frame_of(page)).run === before.run, "the run continues");
  await page.selectOption("#choose-surfaces", "surfaces");
  expect(await comes_true(page, (f) => f.run === before.run + 1), "with surfaces another run begins");
  await drawn(page);
  const { surfaces } = await scene_of(page);
  expect(surfaces.length === 6, `it has ${surfaces.length} surfaces`);
  const chosen = await page.locator("#choose-surfaces option:checked").textContent();
  expect(/Surfaces/.test(chosen) && !(await page.isVisible(problem)), `the list says so: ${chosen}`);
  const width = await page.locator("#change").evaluate((part) => part.scrollWidth - part.clientWidth);
  expect(width <= 0, `no list sticks out of the panel: ${width} px`);
  expect(problems.length === 0, `no errors or foreign requests: ${problems.join("; ") || "none"}`);
  await close();
}

// The tools above the values: the box holds `wanted`, the files `value`.
async function undo_reset_save({ page, box, wanted, value, expect }) {
  const says = (text) =>
    page_comes_to(page, ([field, wish]) => Number(document.querySelector(field).value) === Number(wish), [box, text]);
  const press = (name) => page.getByRole("button", { name, exact: true }).click();
  const other = String(Number((0.25 * value).toPrecision(3)));
  await page.waitForTimeout(1600); // not the same drag of a slider
  await page.fill(box, other);
  await page.press(box, "Enter");
  expect(await says(other), `another value is taken: ${other}`);
  const [download] = await Promise.all([page.waitForEvent("download"), press("Save YAML")]);
  const text = readFileSync(await download.path(), "utf8");
  expect(text.includes("changes:") && text.includes(other), `it is saved: ${text.split("\n").at(-2)}`);
  await press("Undo");
  expect(await says(wanted), `undo goes back to ${wanted}`);
  await press("Reset");
  expect(await says(String(Number(value.toPrecision(4)))), `reset goes back to the files' ${value}`);
  const is_off = await page_comes_to(page, () =>
    [...document.querySelectorAll("#change .buttons button")].slice(1).every((button) => button.disabled),
  );
  expect(is_off, "with nothing changed there is nothing to reset or save");
}

export async function operator_stops_it_and_starts_it_again({ browser, program, expect }) {
  const { page, problems, close } = await open_page(browser, cheap(program.link));
  if (!(await follows(page, "panel"))) return close();
  const press = (name) => page.getByRole("button", { name, exact: true }).click();
  const says = (text) =>
    page_comes_to(page, (part) => document.querySelector("#safety").textContent.includes(part), text);
  expect(await comes_true(page, (f) => f.mode === "running"), "the handle is held: it runs");
  await page.click("#tab-safety");
  await page.locator("#safety .emergency-stop").click();
  const stops = await comes_true(page, (f) => f.mode === "fault" && f.safety.fault === 102);
  expect(stops, "the emergency stop ends in a fault");
  expect(await says("Release: the button is pulled out"), "the page says what releases it");
  // notes disappear after a time, maybe before they are read
  await page.evaluate(() => {
    const notices = document.querySelector("#notices");
    window.noted = "";
    const note = () => (window.noted += notices.textContent);
    new MutationObserver(note).observe(notices, { childList: true });
  });
  await press("Reset");
  const refused = await page_comes_to(page, () => window.noted.includes("not reset"));
  expect(refused, "a reset with the button pressed is refused, and the page says so");
  expect((await frame_of(page)).mode === "fault", "and does nothing");
  await press("Emergency stop: pull it out");
  expect(await comes_true(page, (f) => !f.safety.emergency_stop), "the button is pulled out");
  for (const [name, mode] of [
    ["Reset", "ready"],
    ["Arm", "armed"],
    ["Run", "running"],
  ]) {
    await press(name);
    expect(await comes_true(page, (f) => f.mode === mode), `${name} leads to ${mode}`);
  }
  expect(problems.length === 0, `no errors or foreign requests: ${problems.join("; ") || "none"}`);
  await close();
}

// With the key wherever the focus is, and by touch on a phone.
export async function stop_is_always_at_hand({ browser, program, expect }) {
  const { page, problems, close } = await open_page(browser, cheap(program.link));
  if (!(await follows(page, "emergency_stop"))) return close();
  const { page: phone, close: close_phone } = await open_page(browser, cheap(program.link), {
    viewport: { width: 360, height: 640 },
    hasTouch: true,
  });
  for (const [name, view] of [
    ["wide", page],
    ["360 px wide", phone],
  ]) {
    const { width, height } = view.viewportSize();
    const box = await view.locator("#emergency-stop").boundingBox();
    const is_seen =
      box.x >= 0 && box.y >= 0 && box.x + box.width <= width && box.y + box.height <= height;
    const size = `${box.width.toFixed(0)} x ${box.height.toFixed(0)}`;
    expect(is_seen && box.width >= 100 && box.height >= 44, `${name}: the stop is seen, ${size} px`);
  }
  const own = await page.evaluate(() => window.hapticgiant.page);
  const bar = () => page.textContent("#emergency-stop");
  const pull_out = async () => {
    await page.getByRole("button", { name: "Emergency stop: pull it out", exact: true }).click();
    await comes_true(page, (f) => !f.safety.emergency_stop);
  };
  await page.click("#tab-change");
  for (const focus of [".setting input[type=text]", "#scenario", ".setting input[type=range]"]) {
    await page.locator(`${focus} >> visible=true`).first().focus();
    await page.keyboard.press("Escape");
    const stops = await comes_true(page, (f) => f.safety.emergency_stop && f.safety.fault === 102);
    expect(stops, `Esc stops it, focus in ${focus}`);
    expect((await frame_of(page)).safety.stop_pressed_by[0] === own, "a stop of this page");
    await page_comes_to(page, () => document.querySelector("#emergency-stop").ariaPressed === "true");
    expect(/STOPPED.*this page/.test(await bar()), `the bar says so: ${await bar()}`);
    const reported = await page.textContent("#stop-announcement");
    expect(/Emergency stop pressed/.test(reported), `it is announced: ${reported}`);
    await page.click("#tab-safety");
    await pull_out();
    await page.click("#tab-change");
  }
  await phone.tap("#emergency-stop");
  expect(await comes_true(page, (f) => f.safety.emergency_stop), "a tap on the phone presses it");
  await close_phone();
  await page.click("#tab-safety");
  await page.getByRole("button", { name: "Emergency stop: pull it out", exact: true }).click();
  const question = await page.textContent("#safety");
  expect(/was pressed by page \d+\. Release it\?/.test(question), "the question names the page that pressed");
  expect((await frame_of(page)).safety.emergency_stop, "it is still pressed");
  await page.getByRole("button", { name: "Release it", exact: true }).click();
  expect(await comes_true(page, (f) => !f.safety.emergency_stop), "and released then");
  expect(problems.length === 0, `no errors or foreign requests: ${problems.join("; ") || "none"}`);
  await close();
}

export async function old_figures_are_marked({ browser, program, expect }) {
  let [cut, is_silent] = [null, false];
  const { page, close } = await open_page(browser, cheap(program.link), {}, async (opened) => {
    await opened.routeWebSocket(/\/ws/, (socket) => {
      if (cut) return; // a program that is gone
      const server = socket.connectToServer();
      server.onMessage((text) => is_silent || socket.send(text));
      cut = () => Promise.all([socket.close(), server.close()]);
    });
  });
  const can_stop = await follows(page, "emergency_stop");
  // All of it at once, and waited for: a busy machine may be silent for a moment of its own.
  const looks = (mode, filter, stop_note) =>
    page_comes_to(
      page,
      ([text, look, note]) =>
        document.querySelector("#mode").textContent === text &&
        getComputedStyle(document.querySelector("#panel")).filter === look &&
        document.querySelector("#stop-note").textContent.includes(note),
      [mode, filter, can_stop ? stop_note : ""],
    );
  expect(await looks("running", "none", ""), "running: figures are in colour");
  is_silent = true;
  const silent = await looks("no data", "grayscale(1)", "may not reach");
  expect(silent, "nothing comes although it is connected: no data, grey, the stop may not reach it");
  is_silent = false;
  expect(await looks("running", "none", ""), "they come again: running, in colour");
  await cut();
  const lost = await looks("no connection", "grayscale(1)", "cannot reach");
  expect(lost, "the connection is lost: no connection, grey, the stop cannot reach it");
  await close();
}

export async function a_hidden_page_holds_nothing({ browser, program, expect }) {
  let holds = 0;
  const { page, close } = await open_page(browser, cheap(program.link), {}, async (opened) => {
    await opened.routeWebSocket(/\/ws/, (socket) => {
      const server = socket.connectToServer();
      server.onMessage((text) => socket.send(text));
      socket.onMessage((text) => {
        if (JSON.parse(text).type === "hold") holds += 1;
        server.send(text);
      });
    });
  });
  if (!(await follows(page, "panel"))) return close();
  expect(holds === 0, "a page that holds nothing says nothing");
  await page.click("#tab-safety");
  await page.getByText("Override key", { exact: true }).click();
  const many = async (count) => {
    for (let i = 0; i < 600 && holds < count; i++) await page.waitForTimeout(50);
    return holds >= count;
  };
  expect(await many(10), "with the key turned it says that it is there");
  await page.evaluate(() => {
    Object.defineProperty(document, "hidden", { value: true });
    document.dispatchEvent(new Event("visibilitychange"));
  });
  await page.waitForTimeout(500); // what is under way
  const before = holds;
  await page.waitForTimeout(500);
  expect(holds === before, "hidden, it says nothing");
  expect(await comes_true(page, (f) => !f.safety.override_key), "and the key is turned off");
  await close();
}

export async function time_is_controlled({ browser, program, expect }) {
  const { page, problems, close } = await open_page(browser, cheap(program.link));
  if (!(await follows(page, "pause"))) return close();
  await page.click("#pause");
  expect(await comes_true(page, (f) => f.run_state.is_paused), "pause");
  const { time_s } = await frame_of(page);
  await page.keyboard.press(".");
  const steps = await comes_true(page, (f) => f.time_s > time_s);
  const stepped = (await frame_of(page)).time_s - time_s;
  expect(steps && stepped < 0.1, `one step is ${stepped.toFixed(3)} s`);
  await page.click("#pause");
  expect(
    await comes_true(page, (f) => !f.run_state.is_paused && f.time_s > time_s + 0.3),
    "continues",
  );
  await page.selectOption("#speed", "0.25");
  expect(await comes_true(page, (f) => f.run_state.speed === 0.25), "slow motion");
  const before = await frame_of(page);
  await page.keyboard.press("r");
  const again = await comes_true(page, (f) => f.time_s < before.time_s);
  expect(again, "the run starts again");
  await drawn(page);
  await page.selectOption("#scenario", "excavator");
  const is_site = () => window.hapticgiant.scene.environment === "excavator";
  const other = await page_comes_to(page, is_site);
  await drawn(page);
  expect(other, "another scenario, same page");
  expect(problems.length === 0, `no errors or foreign requests: ${problems.join("; ") || "none"}`);
  await close();
}

export async function recording_is_played({ browser, program, command, expect }) {
  const live = await open_page(browser, cheap(program.link));
  const can_record = await follows(live.page, "restart");
  await live.close();
  if (!can_record) return;
  const folder = mkdtempSync(join(tmpdir(), "hapticgiant-"));
  const record = (name, ...more) => {
    const to = join(folder, name);
    // its exit code says that events are missing: it is short
    const args = ["run", "door", "--fast", "--duration", DOOR_OPEN, ...more, "--recordings", to];
    spawnSync(command[0], args);
    return join(to, "latest.mcap");
  };
  const file = record("script");
  const other = record("no_user", "--user", "none");
  const replay = await start_program([command[0], "replay", file, "--view", "--compare", other]);
  const { page, problems, close } = await open_page(browser, cheap(replay.link));
  expect(await comes_true(page, (f) => f.ghost !== null), "a second recording comes along");
  expect(!(await page.isVisible("#hand")), "the handle cannot be taken");
  await page.click("#pause");
  expect(await comes_true(page, (f) => f.run_state.is_paused), "it pauses");
  for (const place of [1, Number(DOOR_OPEN) - 0.5]) {
    await page.locator("#scrub").evaluate((slider, value) => {
      slider.value = String(value);
      for (const name of ["input", "change"]) slider.dispatchEvent(new Event(name));
    }, place);
    const is_there = await comes_true(page, (f) => Math.abs(f.run_state.position_s - place) < 0.05);
    expect(is_there, `scrubbing goes to ${place} s`);
  }
  const pixels = await hide_and_compare(page, "ghost");
  expect(pixels >= SMALLEST_GHOST, `the second recording covers ${pixels} pixels`);
  expect(problems.length === 0, `no errors or foreign requests: ${problems.join("; ") || "none"}`);
  await close();
  await replay.stop();
  rmSync(folder, { recursive: true });
}

export async function token_leaves_the_address({ browser, program, expect }) {
  const { page, problems, close } = await open_page(browser, cheap(program.link));
  const address = new URL(page.url());
  expect(!page.url().includes("token"), `the token has left the address: ${address.hash}`);
  expect((await page.context().cookies()).length === 0, "there is no cookie");
  await page.reload(PATIENCE);
  await drawn(page);
  expect(true, "the page can be loaded again");
  const other = await page.context().newPage();
  await other.goto(address.origin, PATIENCE);
  await other.waitForFunction(
    () => /Open the link/.test(document.querySelector("#story").textContent),
    null,
    PATIENCE,
  );
  expect(await other.evaluate(() => !window.hapticgiant.is_connected), "another tab needs the link");
  await other.close();
  expect(problems.length === 0, `no errors or foreign requests: ${problems.join("; ") || "none"}`);
  await close();
}

export async function program_is_restarted({ browser, program, command, expect }) {
  const { page, close } = await open_page(browser, cheap(program.link));
  if (!(await follows(page, "restart"))) return close();
  await program.stop();
  await page.waitForFunction(() => document.body.dataset.connected === "false", null, PATIENCE);
  const note = await page.textContent("#connection");
  expect(/open its new link/.test(note), `the page says what to do: ${note}`);
  const again = await start_program([...command, "--port", new URL(program.link).port]);
  await page.goto(again.link, PATIENCE);
  await drawn(page);
  expect(true, "the new link works in the same tab");
  await again.stop();
  await close();
}

export async function link_survives_a_restart({ browser, program, command, expect }) {
  const asking = await open_page(browser, cheap(program.link));
  const is_program = await follows(asking.page, "restart");
  await asking.close();
  if (!is_program) return;
  const folder = mkdtempSync(join(tmpdir(), "hapticgiant-"));
  const kept = [...command, "--token-file", join(folder, "token"), "--port"];
  const first = await start_program([...kept, "0"]);
  const { page, close } = await open_page(browser, cheap(first.link));
  await first.stop();
  await page.waitForFunction(() => document.body.dataset.connected === "false", null, PATIENCE);
  const again = await start_program([...kept, new URL(first.link).port]);
  expect(again.link === first.link, "the program started again prints the same link");
  await drawn(page);
  const { time_s } = await frame_of(page);
  expect(await comes_true(page, (f) => f.time_s > time_s), "and the open page continues without a click");
  await close();
  await again.stop();
  rmSync(folder, { recursive: true });
}
