// The pages of a study in a browser, by keys alone.
//
//   node test/study/run.mjs [--case NAME]...                 against the canned study of mock.mjs
//   node test/study/run.mjs OPERATOR_LINK PARTICIPANT_LINK   goes through the next person of a study
//
// Environment: CHROMIUM (default /usr/bin/chromium), TRIAL_S (s until the operator ends a trial,
// with links; default: 5), LANGUAGE_OF_PAGE (with links).
import * as cases from "./cases.mjs";
import { drive, open, start_browser } from "./keyboard.mjs";
import { Mock } from "./mock.mjs";

const wanted = [];
const rest = process.argv.slice(2);
while (rest[0] === "--case") wanted.push(...rest.splice(0, 2).slice(1));

let failures = 0;
function expect(is_true, text) {
  console.log(`${is_true ? "ok    " : "FAILED"} ${text}`);
  if (!is_true) failures += 1;
}

async function drive_links(browser, [operator_link, participant_link]) {
  const operator = await open(browser, operator_link);
  const participant = await open(browser, participant_link);
  const look = async (screen, _page, _leading, phase = "") => console.log(`      ${screen} ${phase}`);
  const trial_s = Number(process.env.TRIAL_S ?? 5);
  const language = process.env.LANGUAGE_OF_PAGE ?? null;
  const visited = await drive(operator.page, participant.page, { trial_s, language, look });
  expect(true, `the whole session of ${visited.at(-1).code}, by keys`);
  for (const { problems } of [operator, participant]) {
    expect(problems.length === 0, `no errors or foreign requests: ${problems.join("; ") || "none"}`);
  }
}

const browser = await start_browser();
if (rest.length === 2) {
  await drive_links(browser, rest).catch((error) => expect(false, String(error)));
} else {
  for (const [name, run] of Object.entries(cases)) {
    if (wanted.length > 0 && !wanted.includes(name)) continue;
    console.log(`-- ${name.replaceAll("_", " ")}`);
    const mock = new Mock();
    const links = await mock.listen();
    try {
      await run({ browser, mock, links, expect });
    } catch (error) {
      expect(false, String(error));
    }
    for (const context of browser.contexts()) await context.close();
    mock.close();
  }
}
await browser.close();
process.exit(failures === 0 ? 0 : 1);
