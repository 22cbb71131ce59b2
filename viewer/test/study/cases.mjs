// What the pages of a study do, in a browser, with the canned study of mock.mjs. Each case gets
// {browser, mock, links, expect}.
import { violations } from "./axe.mjs";
import { lead_to } from "./mock.mjs";
import { drive, fill_items, is_heading_focused, matches, open, press, tab_to, until } from "./keyboard.mjs";

const no_problems = ({ problems }) => problems.filter((text) => !/WebSocket/.test(text));

function expect_none(expect, found) {
  expect(found.length === 0, `axe has nothing against that: ${found.join("; ") || "none"}`);
}

async function whole_session({ browser, mock, links, expect }, language) {
  const operator = await open(browser, links.operator);
  const participant = await open(browser, links.participant);
  const judged = new Map();
  let are_headings_focused = true;
  const look = async (screen, page, leading, phase = "closed") => {
    if (screen !== "waiting" && !judged.has(screen)) are_headings_focused &&= await is_heading_focused(page);
    for (const [name, looked] of [[screen, page], [`operator, ${phase}`, leading]]) {
      if (judged.has(name)) continue;
      judged.set(name, await violations(looked));
    }
  };
  const visited = await drive(operator.page, participant.page, { trial_s: 0.3, language, look });
  const screens = [...new Set(visited.map(({ screen }) => screen))].sort().join(" ");
  expect(screens === "break end form instruction trial waiting", `all screens are passed by keys: ${screens}`);
  expect(are_headings_focused, "a new screen has the focus at its heading");
  for (const [name, found] of judged) expect(found.length === 0, `axe, ${name}: ${found.join("; ") || "none"}`);
  const [tlx, impression, sus] = mock.saved;
  expect(tlx?.form === "tlx" && tlx.answers.mental === 15 && tlx.answers.frustration === 40, "the TLX has what was chosen");
  expect(Object.keys(tlx?.pairs ?? {}).length === 15, "and its 15 pairs");
  expect(impression?.answers.remarks === "nothing else", "an own form has its text");
  expect(Object.values(sus?.answers ?? {}).length === 10, "the SUS has ten answers");
  for (const each of [operator, participant]) {
    const problems = no_problems(each);
    expect(problems.length === 0, `no errors or foreign requests: ${problems.join("; ") || "none"}`);
  }
  return { participant, visited };
}

export async function whole_session_in_english(given) {
  const { visited } = await whole_session(given, null);
  given.expect(visited.some(({ text }) => text === "Use the handle now"), "the words are English");
}

export async function whole_session_in_german(given) {
  const { visited } = await whole_session(given, "de");
  given.expect(visited.some(({ text }) => text === "Benutzen Sie jetzt den Griff"), "the words are German");
}

export async function nothing_is_answered_beforehand({ browser, mock, links, expect }) {
  const { page } = await open(browser, links.participant);
  lead_to(mock, "form", "tlx");
  await until(page, () => document.body.dataset.screen === "form");
  const said = await page.locator("[role=slider]").evaluateAll((all) => all.map((each) => each.ariaValueText));
  expect(said.length === 6 && said.every((text) => text === "not answered"), `the scales are not answered: ${said[0]}`);
  await tab_to(page, "[role=slider]");
  await page.keyboard.press("ArrowRight");
  await press(page, ".main");
  const alert = await page.textContent("[role=alert].problem.alert");
  expect(/5 answers are missing/.test(alert), `what is missing is said: ${alert}`);
  const at = await page.evaluate(() => [...document.querySelectorAll("[role=slider]")].indexOf(document.activeElement));
  expect(at === 1, `the focus goes to the first that is missing: ${at}`);
  const shown = await page.locator(".item .problem:visible").count();
  expect(shown === 5, `each of them says so: ${shown}`);
  expect_none(expect, await violations(page));
  expect(mock.saved.length === 0, "nothing is sent");
}

export async function a_finger_answers({ browser, mock, links, expect }) {
  const { page, context } = await open(browser, links.participant, { hasTouch: true });
  lead_to(mock, "form", "tlx");
  await until(page, () => document.body.dataset.screen === "form");
  const sliders = page.locator("[role=slider]");
  const [first, second, third] = await Promise.all([0, 1, 2].map((i) => sliders.nth(i).boundingBox()));
  await page.touchscreen.tap(first.x + first.width / 2, first.y + 20);
  await page.mouse.move(second.x + 30, second.y + 20);
  await page.mouse.down();
  await page.mouse.move(second.x + second.width + 50, second.y + 25, { steps: 4 });
  await page.mouse.up();
  const tools = await context.newCDPSession(page);
  const finger = { x: third.x + 200, y: third.y + 20, yDistance: -300, gestureSourceType: "touch" };
  await tools.send("Input.synthesizeScrollGesture", finger);
  const values = await sliders.evaluateAll((all) => all.slice(0, 3).map((each) => each.dataset.answered === "true" && each.ariaValueNow));
  expect(values.join() === "50,100,false", `a tap and a drag answer, a finger that scrolls does not: ${values}`);
}

export async function draft_survives({ browser, mock, links, expect }) {
  const { page } = await open(browser, links.participant);
  lead_to(mock, "form", "impression");
  await until(page, () => document.body.dataset.screen === "form");
  await fill_items(page);
  await page.reload();
  await until(page, () => document.body.dataset.screen === "form");
  const after = await page.evaluate(() => [
    document.querySelector(":checked")?.value,
    document.querySelector("[role=slider]").ariaValueNow,
    document.querySelector("textarea").value,
  ]);
  expect(after.join() === "3,2,nothing else", `a draft survives a reload: ${after}`);

  mock.deaf = true;
  mock.cut();
  await until(page, () => document.body.dataset.connected === "false");
  const line = await page.textContent("#connection");
  expect(/connection is lost/.test(line), `a lost connection is shown: ${line}`);
  expect_none(expect, await violations(page));
  await press(page, ".main");
  const lost = await page.textContent(".problem.alert:not(:empty)");
  expect(/kept here/.test(lost), `answers that could not be sent are kept: ${lost}`);
  mock.deaf = false;
  await until(page, () => document.body.dataset.connected === "true");
  mock.refuse_next = "disk full";
  await press(page, ".main");
  await until(page, () => /disk full/.test(document.querySelector(".problem.alert").textContent));
  expect(true, "a refusal is shown");
  await press(page, ".main");
  await until(page, () => document.body.dataset.screen === "break");
  expect(mock.saved.length === 1 && mock.saved[0].answers.real === 3, "and the answers can be sent again");
  const drafts = await page.evaluate(() => Object.keys(sessionStorage).filter((key) => /draft/.test(key)));
  expect(drafts.length === 0, `then the draft is gone: ${drafts.join() || "none left"}`);
}

export async function escape_stops({ browser, mock, links, expect }) {
  const { page } = await open(browser, links.operator);
  lead_to(mock, "practice");
  await until(page, () => document.body.dataset.phase === "ready");
  await page.keyboard.press("s");
  await until(page, () => document.body.dataset.phase === "running");
  const frame = await (await page.waitForSelector("iframe", { state: "attached" })).contentFrame();
  await frame.waitForFunction(() => /token=ab&show=trial/.test(document.getElementById("received")?.textContent));
  await press(page, "#do-abort");
  expect(await matches(page, "#why-text"), "who throws a trial away is asked why");
  await page.keyboard.press("Enter");
  expect(/reason/.test(await page.textContent("#why .problem")), "and has to say it");
  expect_none(expect, await violations(page));
  await page.keyboard.type("the handle slip");
  await page.keyboard.press("Escape");
  await until(page, () => document.body.dataset.phase === "failed");
  expect(mock.stops === 1, "Esc stops by the study server, also while one types");
  expect(await mock.receives("emergency stop"), `and by the run's page: ${mock.received.join()}`);
  const problem = await page.textContent("#problem");
  expect(/stopped by the operator/.test(problem), `the problem is an alert: ${problem}`);
  expect_none(expect, await violations(page));

  await page.keyboard.press("s");
  await until(page, () => document.body.dataset.phase === "running");
  await press(page, "#do-abort");
  await page.keyboard.type("slipped");
  await page.keyboard.press("Enter");
  await until(page, () => document.body.dataset.phase === "ready");
  expect(mock.whys.join() === "slipped", "a reason is sent");
  await tab_to(page, "#note");
  await page.keyboard.type("seS note");
  await page.keyboard.press("Enter");
  await until(page, () => document.querySelector("#notes-list li"));
  const phase = await page.evaluate(() => document.body.dataset.phase);
  expect(mock.notes[0].text === "seS note" && phase === "ready", "letters of a note are no commands");
}

export async function operator_sees_what_is_missing({ browser, mock, links, expect }) {
  const { page } = await open(browser, links.operator);
  lead_to(mock, "trial");
  await until(page, () => document.body.dataset.phase === "ready");
  await page.keyboard.press("s");
  await until(page, () => document.body.dataset.phase === "running");
  await page.keyboard.press("e");
  await until(page, () => !document.getElementById("last").hidden);
  const text = await page.evaluate(() => document.getElementById("last").innerText);
  expect(/Missing event: closed/.test(text), "the last trial names the event that is missing");
  expect(/time_s\s+no value: event 'closed' is missing/.test(text), "and why a measure has no value");
  const [name, whole] = await page.evaluate(() =>
    ["#last th", "#last table"].map((part) => document.querySelector(part).getBoundingClientRect().width),
  );
  expect(name > 0.3 * whole, `which leaves room for its name: ${name.toFixed(0)} of ${whole.toFixed(0)} px`);
  expect_none(expect, await violations(page));
}

export async function the_list_shows_who_is_there({ browser, mock, links, expect }) {
  const { page } = await open(browser, links.operator, { viewport: { width: 1280, height: 720 } });
  mock.reset();
  mock.people = mock.people.flatMap((person, i) =>
    Array.from({ length: 5 }, (_, k) => ({ ...person, code: `Q${i}${k}`, steps: person.steps.map((each) => ({ ...each })) })),
  );
  mock.do_begin({ code: "Q23" });
  mock.send_state();
  await until(page, () => document.querySelector('#people-list [data-status="open"]') !== null);
  const is_seen = await page.evaluate(() => {
    const [list, item] = ["#people-list", '#people-list [data-status="open"]'].map((each) =>
      document.querySelector(each).getBoundingClientRect(),
    );
    return item.top >= list.top && item.bottom <= list.bottom;
  });
  expect(is_seen, "of twenty participants, the one who is there is in view");
}

export async function operator_sees_loss({ browser, mock, links, expect }) {
  const { page } = await open(browser, links.operator);
  lead_to(mock, "trial");
  await until(page, () => document.body.dataset.phase === "ready");
  mock.deaf = true;
  mock.cut();
  await until(page, () => document.body.dataset.connected === "false");
  const text = await page.textContent("#connection");
  expect(/No connection/.test(text), `the loss of the study server is an alert: ${text}`);
  expect_none(expect, await violations(page));
  const filter = await page.evaluate(() => getComputedStyle(document.querySelector("#now")).filter);
  expect(/grayscale/.test(filter), "old data is grey");
  await page.keyboard.press("Escape");
  const answer = await page.textContent("#stop-answer");
  expect(/cannot be reached/.test(answer), `a stop that goes nowhere says so: ${answer}`);
  mock.deaf = false;
  await until(page, () => document.body.dataset.connected === "true");
  expect((await page.textContent("#connection")) === "", "it connects again");
}
