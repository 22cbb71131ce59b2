// The page for everyone: without WebGL, without a mouse, on a phone, and for a second page. Each case
// gets {browser, program, expect}, as those of cases.mjs.
import { violations } from "../study/axe.mjs";
import {
  NO_SPACE,
  arc,
  cheap,
  comes_true,
  drag_along,
  drawn,
  frame_of,
  open_page,
  page_comes_to,
  scene_of,
  start_browser,
} from "./browser.mjs";

const OPEN = 0.5; // rad
const FINGER = 44; // px
const TABS = ["feel", "joints", "change", "safety", "events"];
const PHONES = {
  "phone upright": { width: 390, height: 844 },
  "phone on its side": { width: 844, height: 390 },
  "small phone upright": { width: 360, height: 640 },
};

const TABLET = { width: 820, height: 1180 };

async function without_space(program, use, options = {}) {
  const browser = await start_browser(NO_SPACE);
  const opened = await open_page(browser, cheap(program.link), options);
  await use(opened);
  await browser.close();
}

function none(problems) {
  return [problems.length === 0, `no errors or foreign requests: ${problems.join("; ") || "none"}`];
}

export async function without_webgl_only_the_space_is_missing({ program, expect }) {
  await without_space(program, async ({ page, problems }) => {
    expect(await page.evaluate(() => window.hapticgiant.is_flat), "there is no WebGL");
    const note = await page.textContent("#no-space");
    expect(/No 3-D picture.*WebGL/.test(note), `the page says why there is no 3-D picture: ${note}`);
    const drawn = await page.evaluate(() =>
      [...document.querySelectorAll(".flat canvas")].map((canvas) => {
        const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
        return new Set(new Uint32Array(data.buffer)).size;
      }),
    );
    expect(drawn.length === 2 && drawn.every((colors) => colors > 20), `two views are drawn, in ${drawn} colours`);
    const mode = await page_comes_to(page, () => document.querySelector("#mode").textContent === "running");
    expect(mode, "the state is shown");
    expect(!(await page.isVisible("#view")), "no camera is offered");
    const keys = await keys_listed(page);
    expect(/Hand/.test(keys) && !/camera|look around/.test(keys), "nor listed among the keys");
    for (const tab of TABS) {
      await page.click(`#tab-${tab}`);
      expect((await page.textContent(`#${tab}`)).length > 20, `the panel shows ${tab}`);
    }
    await page.click("#show-plots");
    expect((await page.locator(".plot").count()) > 1, "plots are drawn");
    await page.click("#show-plots");
    expect(...none(problems));
  });
}

export async function without_webgl_the_hand_opens_the_door({ program, expect }) {
  await without_space(program, async ({ page }) => {
    const frame = await frame_of(page);
    const { twin, commands } = await scene_of(page);
    const angles = Array.from({ length: 25 }, (_, i) => 0.05 * (i + 1));
    await drag_along(page, arc(frame.p_B_H_m, twin.p_B_root_m, angles), async () => {
      const opens = await comes_true(page, (f) => f.q_twin[0] > OPEN);
      expect(opens, `dragging in the view from above opens the door: ${(await frame_of(page)).q_twin[0]} rad`);
    });
    expect(await comes_true(page, (f) => !f.hand.active), "the hand lets go");
    if (!commands.includes("emergency_stop")) return;
    await page.click("#emergency-stop");
    expect(await comes_true(page, (f) => f.safety.emergency_stop), "STOP stops");
  });
}

async function keys_listed(page) {
  await page.click("#show-keys");
  const text = await page.textContent("#keys");
  await page.click("#close-keys");
  return text;
}

// Again if the window has lost the focus to another one of the tests, and with it the hand.
async function hold_down(page, key) {
  for (let i = 0; i < 5; i++) {
    await page.bringToFront();
    await page.keyboard.down(key);
    if (await comes_true(page, (f) => f.hand.active, 20_000)) return true;
    await page.keyboard.up(key);
  }
  return false;
}

export async function keys_alone_open_the_door({ browser, program, expect }) {
  const { page, problems, close } = await open_page(browser, cheap(program.link));
  expect(await hold_down(page, "w"), "W takes the hand");
  const opens = await comes_true(page, (f) => f.q_twin[0] > OPEN);
  const { q_twin, force_N } = await frame_of(page);
  expect(opens, `W alone pushes the door open: ${q_twin[0]} rad, ${Math.hypot(...force_N).toFixed(0)} N`);
  await page.keyboard.up("w");
  expect(await comes_true(page, (f) => !f.hand.active), "the released key lets go");
  expect(await hold_down(page, "ArrowLeft"), "arrows push, too");
  await page.evaluate(() => window.dispatchEvent(new Event("blur")));
  expect(await comes_true(page, (f) => !f.hand.active), "a window without focus lets go");
  await page.keyboard.up("ArrowLeft");
  await page.focus("#tab-feel");
  await page.keyboard.press("ArrowRight");
  expect(await page.isVisible("#joints"), "in the tabs arrows go to the next one");
  expect(!(await frame_of(page)).hand.active, "and do not push");

  await page.keyboard.press("?");
  const dialog = page.getByRole("dialog", { name: "Keys" });
  expect(await dialog.isVisible(), "? shows the keys");
  const keys = await dialog.textContent();
  expect(/30 N/.test(keys) && /first person/.test(keys), "with the largest force of a key and the cameras");
  const focused = await page.evaluate(() => document.activeElement.id);
  expect(focused === "close-keys", `its button has the focus: ${focused}`);
  await page.keyboard.press("Enter");
  expect(!(await dialog.isVisible()), "Enter closes it");
  expect((await page.evaluate(() => document.activeElement.id)) === "tab-joints", "the focus goes back");
  expect(...none(problems));
  await close();
}

// As axe-core judges, light and dark.
export async function screens_are_accessible({ browser, program, expect }) {
  const { page, close } = await open_page(browser, cheap(program.link));
  const judge = async (screen, view = page) => {
    const found = await violations(view);
    expect(found.length === 0, `axe-core finds nothing, light and dark: ${screen} ${found.join("; ")}`);
  };
  for (const tab of TABS) {
    await page.click(`#tab-${tab}`);
    await judge(tab);
  }
  await page.click("#show-plots");
  await judge("plots");
  await page.click("#show-keys");
  await judge("keys");
  await page.click("#close-keys");
  await page.click("#layers");
  await judge("layers");
  await page.evaluate(() => (document.querySelector("#layers").open = false));
  await page.click("#show-plots");
  const box = "[data-setting]:not(:disabled)";
  if ((await page.locator(box).count()) > 0) {
    await page.click("#tab-change");
    await page.locator(box).first().fill("-1e9");
    await page.locator(box).first().press("Enter");
    await judge("a refused value");
  }
  await page.keyboard.press("Escape");
  await comes_true(page, (f) => f.safety.emergency_stop);
  await page.click("#tab-safety");
  await judge("stopped");
  await close();
  await without_space(program, ({ page: flat }) => judge("without WebGL", flat));
  for (const [name, viewport] of Object.entries(PHONES)) {
    const phone = await open_page(browser, cheap(program.link), { viewport, hasTouch: true });
    await judge(name, phone.page);
    await phone.close();
  }
  const hand = await open_page(browser, cheap(`${program.link}&show=hand`));
  await judge("the hand alone", hand.page);
  await hand.close();
}

export async function phones_have_room_for_fingers({ browser, program, expect }) {
  for (const [name, viewport] of Object.entries(PHONES)) {
    const { page, close } = await open_page(browser, cheap(program.link), { viewport, hasTouch: true });
    const { width, height } = viewport;
    const stop = await page.locator("#emergency-stop").boundingBox();
    const is_seen = stop.x >= 0 && stop.y >= 0 && stop.x + stop.width <= width && stop.y + stop.height <= height;
    const is_under_thumb = stop.y > 0.5 * height && stop.height >= FINGER;
    expect(is_seen && is_under_thumb, `${name}: STOP is seen, at the bottom: ${stop.y.toFixed(0)} of ${height} px`);
    const picture = await page.locator("#stage").boundingBox();
    const share = picture.height / height;
    expect(share >= 0.5, `${name}: the picture has ${(100 * share).toFixed(0)} % of the height`);
    const cover = await page.locator("#hand").boundingBox();
    const is_clear = cover.y >= picture.y + picture.height - 1;
    expect(is_clear, `${name}: the hand's buttons do not cover the picture`);
    const handle = await page.evaluate(() => window.hapticgiant.handle_on_screen);
    const is_inside = handle.x > 0 && handle.x < width && handle.y > picture.y && handle.y < picture.y + picture.height;
    expect(is_inside, `${name}: the handle is in the picture`);
    for (const tab of [...TABS, "plots"]) {
      await page.click(tab === "plots" ? "#show-plots" : `#tab-${tab}`);
      const small = await page.evaluate(too_small, FINGER);
      expect(small.length === 0, `${name}, ${tab}: all buttons have ${FINGER} px: ${small.join(", ") || "yes"}`);
      const wide = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
      expect(wide <= 0, `${name}, ${tab}: nothing sticks out of the page`);
    }
    await close();
  }
}

// What fingers press and is smaller; of a check box its label counts, words of a text do not.
function too_small(least) {
  return [...document.querySelectorAll("button:not(.term), select, summary, input[type=text], input[type=range], .check")]
    .filter((part) => part.checkVisibility())
    .map((part) => ({ part, box: part.getBoundingClientRect() }))
    .filter(({ box }) => box.width < least - 0.5 || box.height < least - 0.5)
    .map(({ part, box }) => `${part.id || part.textContent || part.type} ${box.width | 0}x${box.height | 0}`);
}

export async function a_tablet_shows_all_at_once({ browser, program, expect }) {
  const { page, close } = await open_page(browser, cheap(program.link), { viewport: TABLET, hasTouch: true });
  const bar = await page.locator("#bar").evaluate(({ scrollWidth, clientWidth }) => scrollWidth - clientWidth);
  expect(bar <= 0, `no tool of the bar sticks out: ${bar} px`);
  const feel = await page.locator("#feel").evaluate(({ scrollWidth, clientWidth }) => scrollWidth - clientWidth);
  expect(feel <= 0, `no column of the panel sticks out: ${feel} px`);
  await close();
}

// Fingers of a phone, as the browser itself gets them.
async function fingers_of(page) {
  const session = await page.context().newCDPSession(page);
  const send = (type, places) =>
    session.send("Input.dispatchTouchEvent", { type, touchPoints: places.map(({ x, y }, id) => ({ x, y, id })) });
  return {
    put: (...places) => send("touchStart", places),
    move: (...places) => send("touchMove", places),
    lift: () => send("touchEnd", []),
  };
}

export async function fingers_open_the_door_and_turn_the_view({ browser, program, expect }) {
  const phone = { viewport: PHONES["phone upright"], hasTouch: true, isMobile: true };
  const { page, problems, close } = await open_page(browser, cheap(program.link), phone);
  const fingers = await fingers_of(page);
  const handle_px = () => page.evaluate(() => window.hapticgiant.handle_on_screen);
  const seen = (p_B) => page.evaluate((p) => window.hapticgiant.on_screen(p), p_B);
  const { p_B_H_m } = await frame_of(page);
  const { p_B_root_m } = (await scene_of(page)).twin;

  await fingers.put(await handle_px());
  expect(await comes_true(page, (f) => f.hand.active), "a finger at the ring takes the handle");
  for (const point of arc(p_B_H_m, p_B_root_m, Array.from({ length: 25 }, (_, i) => 0.05 * (i + 1)))) {
    const { time_s } = await frame_of(page);
    await fingers.move(await seen(point));
    await comes_true(page, (f) => f.time_s > time_s + 0.06);
  }
  const opens = await comes_true(page, (f) => f.q_twin[0] > OPEN);
  expect(opens, `it drags the door open: ${(await frame_of(page)).q_twin[0]} rad`);
  await fingers.lift();
  expect(await comes_true(page, (f) => !f.hand.active), "the lifted finger lets go");

  const [at, beside] = [{ x: 60, y: 400 }, { x: 150, y: 400 }];
  const before = await seen(p_B_root_m);
  await fingers.put(at);
  for (let x = at.x; x <= beside.x; x += 15) await fingers.move({ x, y: at.y });
  await fingers.lift();
  const turned = await page_comes_to(page, ([p, { x, y }]) => {
    const now = window.hapticgiant.on_screen(p);
    return Math.hypot(now.x - x, now.y - y) > 10;
  }, [p_B_root_m, before]);
  expect(turned && !(await frame_of(page)).hand.active, "a finger elsewhere turns the view, and holds nothing");
  const size = async () => {
    const [low, high] = [await seen(p_B_root_m), await seen([p_B_root_m[0], p_B_root_m[1], p_B_root_m[2] + 0.5])];
    return Math.hypot(low.x - high.x, low.y - high.y);
  };
  await drawn(page);
  const small = await size();
  await fingers.put({ x: 60, y: 400 }, { x: 100, y: 400 });
  for (let i = 1; i <= 6; i++) await fingers.move({ x: 60 - 2 * i, y: 400 }, { x: 100 + 4 * i, y: 400 });
  await fingers.lift();
  await drawn(page);
  const large = await size();
  expect(large > 1.2 * small, `two fingers that part come nearer: ${small.toFixed(0)} to ${large.toFixed(0)} px`);
  const scrolled = await page.evaluate(() => [scrollX, scrollY, visualViewport.scale]);
  expect(String(scrolled) === "0,0,1", `the page itself neither scrolls nor zooms: ${scrolled}`);
  expect(...none(problems));
  await close();
}

export async function a_second_page_asks_for_the_hand({ browser, program, expect }) {
  const first = await open_page(browser, cheap(program.link));
  const second = await open_page(browser, cheap(program.link));
  const reads = (page, pattern) =>
    page_comes_to(page, (text) => new RegExp(text).test(document.querySelector("#holder").textContent), pattern);
  const [own, other] = await Promise.all([first, second].map(({ page }) => page.evaluate(() => window.hapticgiant.page)));
  await first.page.keyboard.down("d");
  expect(await reads(second.page, `^Page ${own} has the hand`), "the second page says who has the hand");
  expect(!(await second.page.isVisible("#hand")), "and shows no buttons of a hand that it does not have");
  expect(!(await second.page.isVisible("#grip")), "nor a ring to drag");
  await second.page.keyboard.press("w");
  const is_noted = await page_comes_to(second.page, () => /has the hand/.test(document.querySelector("#notices").textContent));
  expect(is_noted, "a push there is refused, and the page says so");
  if ((await scene_of(second.page)).commands.includes("ask_for_hand")) {
    await second.page.click("#ask-for-hand");
    expect(await reads(first.page, `Page ${other} asks for the hand`), "the first page reads that it is asked");
    expect(await reads(second.page, "You have asked for it"), "the second that it has asked");
  }
  await first.page.keyboard.up("d");
  const is_free = await page_comes_to(second.page, () => document.querySelector("#holder").hidden);
  expect(is_free, "the first lets go: the hand is free");
  await second.page.keyboard.down("d");
  expect(await reads(first.page, `^Page ${other} has the hand`), "the second can take it now");
  await second.page.keyboard.up("d");
  await first.close();
  await second.close();
}

export async function the_page_is_left_as_it_was({ browser, program, expect }) {
  const { page, close } = await open_page(browser, cheap(program.link));
  await page.selectOption("#view", "top");
  await page.click("#show-plots");
  await page.click("#tab-events");
  await page.reload();
  await page_comes_to(page, () => window.hapticgiant?.is_drawn);
  const view = await page.inputValue("#view");
  expect(view === "top", `the camera is remembered: ${view}`);
  expect((await page.isVisible("#plots")) && (await page.isVisible("#events")), "plots and tab, too");
  await close();
}
