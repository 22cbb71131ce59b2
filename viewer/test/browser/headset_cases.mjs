// A headset, emulated by IWER: what its wearer holds, presses and places.
import {
  PATIENCE,
  cheap,
  comes_true,
  frame_of,
  open_page,
  page_comes_to,
  pictures,
  scene_of,
  wear_headset,
} from "./browser.mjs";

const STOP = [-0.6, 1.06, -0.53]; // m, of the board's button in the headset's space; board.ts

// Puts the right controller at `from` and turns it to `to`, in the headset's space.
async function point(page, from, to) {
  const [x, y, z] = to.map((end, i) => end - from[i]);
  const yaw = Math.atan2(-x, -z);
  const pitch = Math.atan2(y, Math.hypot(x, z));
  await page.evaluate(
    ({ from, yaw, pitch }) => {
      const { position, quaternion } = window.xr_device.controllers.right;
      const [c, s, u, v] = [yaw, pitch].flatMap((angle) => [Math.cos(angle / 2), Math.sin(angle / 2)]);
      position.set(...from);
      quaternion.set(c * v, s * u, -s * v, c * u);
    },
    { from, yaw, pitch },
  );
  await pictures(page);
}

async function pull_trigger(page, share) {
  await page.evaluate((share) => window.xr_device.controllers.right.updateButtonValue("trigger", share), share);
  await pictures(page);
}

async function enter(page, kind) {
  await page.click(`#enter-${kind}`);
  return page_comes_to(page, () => window.hapticgiant.is_hand_tracked);
}

export async function headset_holds_the_handle({ browser, program, expect }) {
  const { page, problems, close } = await open_page(browser, cheap(program.link), {}, wear_headset);
  const view = await page.evaluate(() => window.hapticgiant.on_screen([0, 0, 0]));
  for (const kind of ["vr", "ar"]) {
    await page.click(`#enter-${kind}`);
    const worn = await page_comes_to(page, () => window.hapticgiant.is_hand_tracked);
    expect(worn, `${kind.toUpperCase()} begins and sees a controller`);
    await page.evaluate(() => window.xr_device.controllers.right.position.set(0.2, 1.2, -0.4));
    await pictures(page); // until three has its position
    await page.evaluate(() => window.xr_device.controllers.right.updateButtonValue("trigger", 1));
    expect(await comes_true(page, (f) => f.hand.active), "the trigger takes hold of the handle");
    const { hand } = await frame_of(page);
    await page.evaluate(() => window.xr_device.controllers.right.position.set(0.2, 1.2, -0.5));
    const follows = await comes_true(
      page,
      (f) => Math.hypot(...f.hand.p_B_m.map((x, i) => x - hand.p_B_m[i])) > 0.05,
    );
    expect(follows, "its target follows the controller");
    await pictures(page);
    await page.waitForTimeout(200);
    const { hand: { p_B_m }, time_s } = await frame_of(page);
    await comes_true(page, (f) => f.time_s > time_s + 1);
    const { hand: later } = await frame_of(page);
    const drift = Math.hypot(...later.p_B_m.map((x, i) => x - p_B_m[i]));
    expect(drift < 1e-4, `nothing but the wearer moves the wearer: ${(1000 * drift).toFixed(2)} mm in a second`);
    await page.evaluate(() => window.xr_device.controllers.right.updateButtonValue("trigger", 0));
    expect(await comes_true(page, (f) => !f.hand.active), "letting go of the trigger lets go");
    await page.evaluate(() => window.xr_device.activeSession?.end());
    await page.waitForFunction(() => !window.xr_device.activeSession, null, PATIENCE);
    await pictures(page);
    const now = await page.evaluate(() => window.hapticgiant.on_screen([0, 0, 0]));
    const moved = Math.hypot(now.x - view.x, now.y - view.y);
    expect(moved < 1, `the page looks from where it did before: ${moved.toFixed(1)} px`);
  }
  expect(problems.length === 0, `no errors or foreign requests: ${problems.join("; ") || "none"}`);
  await close();
}

export async function headset_board_stops({ browser, program, expect }) {
  const { page, problems, close } = await open_page(browser, cheap(program.link), {}, wear_headset);
  if (!(await scene_of(page)).commands.includes("emergency_stop")) return close();
  await enter(page, "vr");
  await point(page, [0, 1.2, -0.1], [STOP[0], STOP[1] + 0.2, STOP[2]]);
  await pull_trigger(page, 1);
  await pull_trigger(page, 0);
  const { safety, hand } = await frame_of(page);
  expect(!safety.emergency_stop && !hand.active, "the board above its button is only read");
  await point(page, [0, 1.2, -0.1], STOP);
  await pull_trigger(page, 1);
  expect(await comes_true(page, (f) => f.safety.emergency_stop), "a trigger that points at STOP stops");
  expect(!(await frame_of(page)).hand.active, "and takes hold of nothing");
  await pull_trigger(page, 0);
  expect(problems.length === 0, `no errors or foreign requests: ${problems.join("; ") || "none"}`);
  await close();
}

export async function headset_hand_pinches({ browser, program, expect }) {
  const { page, problems, close } = await open_page(browser, cheap(program.link), {}, wear_headset);
  await page.evaluate(() => (window.xr_device.primaryInputMode = "hand"));
  expect(await enter(page, "vr"), "a hand is seen");
  await page.evaluate(() => window.xr_device.hands.right.position.set(0.2, 1.2, -0.4));
  await pictures(page);
  await page.evaluate(() => window.xr_device.hands.right.updatePinchValue(1));
  expect(await comes_true(page, (f) => f.hand.active), "a pinch takes hold of the handle");
  await page.evaluate(() => window.xr_device.hands.right.updatePinchValue(0));
  expect(await comes_true(page, (f) => !f.hand.active), "opening the hand lets go");
  expect(problems.length === 0, `no errors or foreign requests: ${problems.join("; ") || "none"}`);
  await close();
}

// The floor of a room, of which the headset knows nothing else.
function know_floor() {
  window.xr_device.installSEM(
    class {
      environmentCanvas = document.createElement("canvas");
      trackedPlanes = new Set();
      trackedMeshes = new Set();

      computeHitTestResults(ray) {
        const direction = [-ray[8], -ray[9], -ray[10]];
        if (direction[1] > -0.1) return [];
        const length = -ray[13] / direction[1];
        const [x, z] = [ray[12] + length * direction[0], ray[14] + length * direction[2]];
        return [new Float32Array([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, 0, z, 1])];
      }
      render() {}
    },
  );
}

export async function headset_places_the_device({ browser, program, expect }) {
  const { page, problems, close } = await open_page(browser, cheap(program.link), {}, wear_headset);
  await page.evaluate(know_floor);
  await enter(page, "ar");
  await page.evaluate(() => window.xr_device.position.set(0, 1.6, 0));
  await point(page, [0.2, 1.2, -0.3], [1.2, 0, -0.6]); // to the right of the wearer
  await page.waitForTimeout(500); // a source of hits has been promised
  await pictures(page);
  await pull_trigger(page, 1);
  await pull_trigger(page, 0);
  expect(!(await frame_of(page)).hand.active, "a trigger that points at the floor places the device");
  await point(page, [0.2, 1.2, -0.3], [1.2, 1.2, -0.6]);
  await pull_trigger(page, 1);
  expect(await comes_true(page, (f) => f.hand.active), "the next one takes hold of the handle");
  await page.waitForTimeout(200);
  const before = await frame_of(page);
  const towards = [-1.2, 0.6].map((part) => part / Math.hypot(1.2, 0.6)); // from the place to the wearer
  await point(page, [0.2 + 0.1 * towards[0], 1.2, -0.3 + 0.1 * towards[1]], [1.2, 1.2, -0.6]);
  await comes_true(page, (f) => Math.hypot(...f.hand.p_B_m.map((x, i) => x - before.hand.p_B_m[i])) > 0.08);
  const { hand } = await frame_of(page);
  const moved = hand.p_B_m.map((x, i) => x - before.hand.p_B_m[i]);
  const [qx, qy, qz, qw] = before.quaternion_B_H;
  const to_user = [2 * (qx * qz + qw * qy), 2 * (qy * qz - qw * qx)]; // the handle's z, level
  const along = (moved[0] * to_user[0] + moved[1] * to_user[1]) / Math.hypot(...to_user);
  expect(along > 0.09, `it stands there turned to the wearer: ${(100 * along).toFixed(1)} of 10 cm towards them`);
  await pull_trigger(page, 0);
  expect(problems.length === 0, `no errors or foreign requests: ${problems.join("; ") || "none"}`);
  await close();
}
