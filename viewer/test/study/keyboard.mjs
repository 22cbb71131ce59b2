// Uses the pages of a study as people do who have no mouse: keys only. What stands on the page is
// read, nothing is clicked.
import { start_browser } from "../browser/browser.mjs";

const PATIENCE_MS = 180_000; // a machine may be slow; nothing is timed
const MOST_TABS = 120;
const POLL_MS = 40;

export { start_browser };

// A page in a context of its own; `problems` collects its errors and requests to other machines.
export async function open(browser, link, options = {}) {
  const context = await browser.newContext({ viewport: { width: 1180, height: 820 }, ...options });
  const page = await context.newPage();
  page.setDefaultTimeout(PATIENCE_MS);
  const problems = [];
  page.on("pageerror", (error) => problems.push(String(error)));
  page.on("console", (line) => line.type() === "error" && problems.push(line.text()));
  page.on("request", (request) => {
    if (!/^(http:\/\/127\.0\.0\.1:|blob:|data:)/.test(request.url())) problems.push(request.url());
  });
  // the page of a run is drawn as cheaply as it can be
  await page.addInitScript(() => {
    if (location.hash.includes("show=")) history.replaceState(null, "", `${location.hash}&quality=fast`);
  });
  await page.goto(link);
  await page.waitForFunction(() => document.body.dataset.connected === "true");
  return { page, problems, context };
}

// Waits until the page comes to `test(argument)`.
export async function until(page, test, argument = null) {
  await page.waitForFunction(test, argument, { timeout: PATIENCE_MS, polling: POLL_MS });
}

export function matches(page, selector) {
  return page.evaluate((wanted) => document.activeElement?.matches(wanted) ?? false, selector);
}

// Presses Tab until what has the focus matches `selector`.
export async function tab_to(page, selector, key = "Tab") {
  for (let i = 0; i < MOST_TABS; i++) {
    if (await matches(page, selector)) return;
    await page.keyboard.press(key);
  }
  const at = await page.evaluate(() => document.activeElement?.outerHTML.slice(0, 200));
  throw new Error(`${selector} is not reached by Tab, the focus is at ${at}`);
}

export async function press(page, selector, key = "Enter") {
  await tab_to(page, selector);
  await page.keyboard.press(key);
}

const screen_of = (page) =>
  page.evaluate(() => {
    const { screen, position, code } = document.body.dataset;
    const part = document.querySelector(".form")?.dataset.part ?? "";
    return { screen, position, code, part, text: document.querySelector("h1").textContent };
  });

export function is_heading_focused(page) {
  return page.evaluate(() => document.activeElement?.tagName === "H1");
}

// Answers the items of the form that is shown, from the first to the last.
export async function fill_items(page) {
  const count = await page.locator(".item").count();
  for (let i = 0; i < count; i++) {
    const item = `.item:nth-of-type(n):is([data-test="${i}"]) *`;
    await page.evaluate((at) => (document.querySelectorAll(".item")[at].dataset.test = at), i);
    await tab_to(page, item);
    if (await matches(page, "[role=slider]")) {
      await page.keyboard.press("Home");
      for (let k = 0; k < 3 + i; k++) await page.keyboard.press("ArrowRight");
    } else if (await matches(page, "[type=radio]")) {
      await page.keyboard.press(String(1 + ((i + 2) % 5)));
    } else await page.keyboard.type("nothing else");
  }
}

// One step of the participant's screen; `look` gets each new one.
async function participant_acts(page, { screen, part }) {
  if (screen === "instruction") return press(page, ".main");
  if (screen === "break") {
    await until(page, () => document.body.dataset.screen !== "break" || !document.querySelector(".main").hidden);
    if ((await screen_of(page)).screen === "break") await press(page, ".main", "Space");
    return;
  }
  if (screen !== "form") return;
  if (part === "pair") {
    const count = await page.textContent(".lead");
    await page.keyboard.press(Number(/\d+/.exec(count)[0]) % 2 ? "1" : "2");
  } else {
    if (part === "items") await fill_items(page);
    await press(page, ".main");
  }
}

// Begins the next person and goes with both keyboards through the whole session. Trials are ended by
// the operator after `trial_s`, unless they have ended by themselves.
export async function drive(operator, participant, { trial_s = 1, language = null, look = async () => {} } = {}) {
  await until(operator, () => document.body.dataset.phase !== undefined);
  if (language !== null) {
    await press(participant, `#language-${language}-first`);
    await until(participant, (wanted) => document.documentElement.lang === wanted, language);
  }
  await look("waiting", participant, operator);
  await press(operator, "#begin");
  let seen = "";
  let acted = "";
  let running_since_ms = null;
  const visited = [];
  for (const end = Date.now() + PATIENCE_MS; Date.now() < end;) {
    const phase = await operator.evaluate(() => document.body.dataset.phase);
    const now = await screen_of(participant);
    const place = `${now.screen} ${now.position} ${now.part}`;
    if (`${place} ${phase}` !== seen) {
      seen = `${place} ${phase}`;
      visited.push({ ...now, phase });
      await look(now.part === "pair" ? "pair" : now.screen, participant, operator, phase);
    }
    if (phase === "complete" && now.screen === "end") return visited;
    if (phase !== "running") running_since_ms = null;
    else running_since_ms ??= Date.now();
    const act = `${place} ${now.part === "pair" ? await participant.textContent(".lead") : ""} ${phase}`;
    if (act !== acted) {
      acted = act;
      if (phase === "ready" || phase === "failed") await operator.keyboard.press("s");
      if (phase === "participant") await participant_acts(participant, now);
    }
    if (running_since_ms !== null && Date.now() - running_since_ms > 1000 * trial_s) {
      await operator.keyboard.press("e");
      await until(operator, () => document.body.dataset.phase !== "running");
    }
    await participant.waitForTimeout(POLL_MS);
  }
  throw new Error(`the session does not come to its end; last: ${seen}`);
}
