// A server of a study that plays a canned one by the contract of `hapticgiant study run`: no device,
// no recordings, two people. For tests of the pages alone.
//
//   node test/study/mock.mjs [DIST]     prints the two links
import { createServer } from "node:http";
import { readFileSync } from "node:fs";
import { dirname, extname, join, normalize, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { WebSocketServer } from "ws";

const here = dirname(fileURLToPath(import.meta.url));
const TYPES = { ".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".svg": "image/svg+xml" };
const POLICY =
  "default-src 'self'; frame-src http://127.0.0.1:*; object-src 'none'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
const TOKENS = { operator: "0a1b", participant: "2c3d" };

// The page of a run: shows what it receives.
const RUN_PAGE = `<!doctype html><html lang="en"><meta charset="utf-8"><title>Run</title>
<link rel="stylesheet" href="run.css"><main><h1>The run</h1><p id="received"></p><button>STOP</button></main><script src="run.js"></script></html>`;
const RUN_SCRIPT = `addEventListener("message", ({ data }) => {
  document.getElementById("received").textContent = data;
  fetch("/received?" + encodeURIComponent(data), { keepalive: true }); // the page goes when the study server has stopped, too
});
document.getElementById("received").textContent = location.hash;`;
const RUN_STYLE = `body { font-family: sans-serif; background: #dfe7f0; color: #1c2630; display: grid; place-items: center; min-height: 90vh; }`;

const texts = (en, de) => ({ en, de });
const DOOR = texts(
  "Use the handle as if it were that of a **normal door**: open it and walk through.",
  "Benutzen Sie den Griff wie den einer **normalen Tür**: öffnen Sie sie und gehen Sie hindurch.",
);
const LEVELS = [texts("very low", "sehr gering"), texts("very high", "sehr hoch")];
const TLX = {
  mental: [texts("Mental demand: how mentally demanding was the task?", "Geistige Anforderung: Wie geistig anstrengend war die Aufgabe?"), LEVELS],
  physical: [texts("Physical demand: how physically demanding was the task?", "Körperliche Anforderung: Wie körperlich anstrengend war die Aufgabe?"), LEVELS],
  temporal: [texts("Temporal demand: how hurried or rushed was the pace of the task?", "Zeitliche Anforderung: Wie gehetzt war das Tempo der Aufgabe?"), LEVELS],
  performance: [texts("Performance: how successful were you in what you were asked to do?", "Leistung: Wie erfolgreich haben Sie die Aufgabe erledigt?"), [texts("perfect", "perfekt"), texts("failure", "misslungen")]],
  effort: [texts("Effort: how hard did you have to work for your performance?", "Anstrengung: Wie sehr mussten Sie sich für Ihre Leistung anstrengen?"), LEVELS],
  frustration: [texts("Frustration: how insecure, discouraged, irritated or annoyed were you?", "Frustration: Wie unsicher, entmutigt, gereizt oder verärgert waren Sie?"), LEVELS],
};
const names = Object.keys(TLX);
const AGREE = [texts("strongly disagree", "stimme gar nicht zu"), texts("strongly agree", "stimme völlig zu")];
const FORMS = {
  tlx: {
    kind: "nasa_tlx",
    items: names.map((name) => ({ name, kind: "slider", text: TLX[name][0], low: 0, high: 100, step: 5, ends: TLX[name][1] })),
    pairs: names.flatMap((a, i) => names.slice(i + 1).map((b) => [a, b])),
  },
  impression: {
    kind: "own",
    about: texts("About the **door** you have just felt.", "Über die **Tür**, die Sie gerade gefühlt haben."),
    items: [
      { name: "real", kind: "likert", text: texts("It felt real.", "Es fühlte sich echt an."), low: 1, high: 7, step: 1, ends: AGREE },
      { name: "weight", kind: "slider", text: texts("How heavy was the door, in kg?", "Wie schwer war die Tür, in kg?"), low: 0, high: 50, step: 0.5, ends: [texts("light", "leicht"), texts("heavy", "schwer")] },
      { name: "remarks", kind: "text", text: texts("What else did you notice?", "Was ist Ihnen sonst aufgefallen?"), low: 0, high: 100, step: 1, ends: [] },
    ],
    pairs: [],
  },
  sus: {
    kind: "sus",
    items: [
      texts("I think that I would like to use this system frequently.", "Ich kann mir gut vorstellen, dieses System häufig zu nutzen."),
      texts("I found the system unnecessarily complex.", "Ich finde das System unnötig komplex."),
      texts("I thought the system was easy to use.", "Ich finde, das System ist einfach zu benutzen."),
      texts("I think that I would need the support of a technical person to be able to use this system.", "Ich glaube, ich bräuchte die Hilfe einer Fachperson, um dieses System zu benutzen."),
      texts("I found the various functions in this system were well integrated.", "Ich finde, die Funktionen des Systems sind gut aufeinander abgestimmt."),
      texts("I thought there was too much inconsistency in this system.", "Ich finde, das System ist zu uneinheitlich."),
      texts("I would imagine that most people would learn to use this system very quickly.", "Ich glaube, dass die meisten Menschen dieses System sehr schnell erlernen."),
      texts("I found the system very cumbersome to use.", "Ich finde das System sehr umständlich."),
      texts("I felt very confident using the system.", "Ich war beim Benutzen des Systems sehr sicher."),
      texts("I needed to learn a lot of things before I could get going with this system.", "Ich musste viel lernen, bevor ich mit dem System umgehen konnte."),
    ].map((text, i) => ({ name: `item_${String(i + 1).padStart(2, "0")}`, kind: "likert", text, low: 1, high: 5, step: 1, ends: AGREE })),
    pairs: [],
  },
};
const INSTRUCTIONS = {
  start: texts(
    "You will move the handle of a large robot.\n\n- Let go at any time.\n- The operator can stop it at once.\n\n<script>alert(1)</script>",
    "Sie bewegen den Griff eines großen Roboters.\n\n- Sie können ihn jederzeit loslassen.\n- Die Leitung kann ihn sofort anhalten.",
  ),
  door: DOOR,
  end: texts("Thank you. Please say to the operator **how it was**.", "Vielen Dank. Bitte sagen Sie der Leitung, **wie es war**."),
};

function steps() {
  const step = (kind, more = {}) => ({ kind, condition: null, repetition: null, form: null, text: null, is_done: false, ...more });
  return [
    step("instruction", { text: "start" }),
    step("instruction", { condition: "door", text: "door" }),
    step("practice", { condition: "door", repetition: 1 }),
    step("trial", { condition: "door", repetition: 1 }),
    step("trial", { condition: "door", repetition: 2 }),
    step("form", { condition: "door", form: "tlx" }),
    step("form", { condition: "door", form: "impression" }),
    step("break"),
    step("form", { form: "sus" }),
    step("instruction", { text: "end" }),
  ];
}

const PARTICIPANT_STEPS = ["instruction", "form", "break"];

export class Mock {
  hand = "mouse";
  rest_s = 2;
  refuse_next = null; // problem of the next answers
  deaf = false; // takes no connection
  saved = []; // answers that were accepted
  received = []; // by pages, to the run's page
  stops = 0;
  whys = [];

  constructor(dist = resolve(here, "../../dist")) {
    this.dist = dist;
    this.reset();
  }

  reset() {
    this.people = ["P01", "P02", "P03", "P04"].map((code, i) => ({
      code, conditions: i % 2 ? ["path", "door"] : ["door", "path"], status: "planned", done: 0, steps: steps(),
    }));
    this.participant = null;
    this.phase = "closed";
    this.problem = null;
    this.run = null;
    this.last = null;
    this.notes = [];
    this.language = "en";
    clearInterval(this.timer);
  }

  async listen() {
    this.server = createServer((request, response) => this.serve(request, response));
    this.run_server = createServer((request, response) => this.serve_run(request, response));
    for (const server of [this.server, this.run_server]) await new Promise((done) => server.listen(0, "127.0.0.1", done));
    this.port = this.server.address().port;
    this.run_port = this.run_server.address().port;
    this.sockets = { operator: new Set(), participant: new Set() };
    this.web = new WebSocketServer({ noServer: true, handleProtocols: () => "hapticgiant-study" });
    this.server.on("upgrade", (request, socket, head) => {
      const page = request.url.slice("/ws/".length);
      const given = (request.headers["sec-websocket-protocol"] ?? "").split(", ");
      if (this.deaf || given[0] !== "hapticgiant-study" || given[1] !== `token.${TOKENS[page]}`) return socket.destroy();
      this.web.handleUpgrade(request, socket, head, (connection) => this.take(page, connection));
    });
    return this.links();
  }

  links() {
    const origin = `http://127.0.0.1:${this.port}`;
    return Object.fromEntries(Object.entries(TOKENS).map(([page, token]) => [page, `${origin}/${page}#token=${token}`]));
  }

  close() {
    clearInterval(this.timer);
    this.cut();
    for (const server of [this.server, this.run_server]) {
      server.close();
      server.closeAllConnections();
    }
  }

  // Breaks all connections, as a network does.
  cut() {
    for (const set of Object.values(this.sockets)) for (const socket of set) socket.terminate();
  }

  serve(request, response) {
    const { pathname } = new URL(request.url, "http://here");
    if (pathname in { "/operator": 0, "/participant": 0 }) {
      return response.writeHead(302, { Location: `/study${pathname}.html` }).end();
    }
    const file = join(this.dist, normalize(pathname));
    let content;
    try {
      content = readFileSync(file);
    } catch {
      return response.writeHead(404).end();
    }
    const type = TYPES[extname(file)] ?? "application/octet-stream";
    response.writeHead(200, { "Content-Type": type, "Content-Security-Policy": POLICY, "Cache-Control": "no-store" }).end(content);
  }

  serve_run(request, response) {
    const url = new URL(request.url, "http://here");
    if (url.pathname === "/received") {
      this.received.push(decodeURIComponent(url.search.slice(1)));
      return response.writeHead(204).end();
    }
    const found = { "/run.js": [RUN_SCRIPT, "text/javascript"], "/run.css": [RUN_STYLE, "text/css"] }[url.pathname] ?? [RUN_PAGE, "text/html"];
    response.writeHead(200, { "Content-Type": found[1] }).end(found[0]);
  }

  // Whether a page says so to the run's page, which has its own connection.
  async receives(text, patience_ms = 30_000) {
    for (const end = Date.now() + patience_ms; Date.now() < end; await new Promise((done) => setTimeout(done, 20))) {
      if (this.received.includes(text)) return true;
    }
    return false;
  }

  take(page, socket) {
    this.sockets[page].add(socket);
    socket.on("close", () => {
      this.sockets[page].delete(socket);
      this.send_state();
    });
    socket.on("message", (data) => {
      const { id, command, ...content } = JSON.parse(String(data));
      const problem = this.obey(page, command, content) ?? null;
      socket.send(JSON.stringify({ kind: "answer", id, problem }));
      this.send_state();
    });
    this.send_state();
  }

  send_state() {
    for (const [page, set] of Object.entries(this.sockets)) {
      const text = JSON.stringify(page === "operator" ? this.operator_state() : this.participant_state());
      for (const socket of set) socket.send(text);
    }
  }

  get person() {
    return this.people.find(({ code }) => code === this.participant);
  }
  get position() {
    if (!this.person) return null;
    const at = this.person.steps.findIndex((step) => !step.is_done);
    return at < 0 ? null : at;
  }
  get step() {
    return this.position === null ? null : this.person.steps[this.position];
  }
  get next() {
    const open = this.people.filter(({ status }) => status === "begun" || status === "planned");
    return (open.find(({ status }) => status === "begun") ?? open[0])?.code ?? null;
  }

  can() {
    const { phase, step } = this;
    const all = [];
    if (phase === "closed") return ["begin"];
    all.push("note");
    if (["participant", "ready", "failed", "complete"].includes(phase)) all.push("leave");
    if (phase === "participant" && step.kind !== "form") all.push("go_on");
    if (["ready", "failed"].includes(phase)) all.push("start");
    if (this.last && ["ready", "participant"].includes(phase)) all.push("repeat");
    if (phase === "running") all.push("end");
    if (["starting", "running", "moving"].includes(phase)) all.push("abort", "stop");
    return all;
  }

  operator_state() {
    return {
      kind: "state", title: "Door and path", people: "real", hand: this.hand,
      participants: this.people.map(({ code, conditions, status, steps }) => ({
        code, conditions, status, done: steps.filter((step) => step.is_done).length, of: steps.length,
      })),
      next: this.next, participant: this.participant,
      participant_page: { link: this.links().participant, is_connected: this.sockets.participant.size > 0, language: this.language },
      steps: this.person?.steps ?? [], position: this.position, phase: this.phase, problem: this.problem,
      run: this.run, last: this.last, notes: this.notes,
      markers: [{ name: "EEG", is_connected: true, count: 12 }, { name: "Eye tracker", is_connected: false, count: 0 }],
      can: this.can(),
    };
  }

  participant_state() {
    const { step, person, language } = this;
    const base = {
      kind: "state", title: "Door and path", code: this.participant, draft: "mock", languages: ["en", "de"], language, position: this.position,
      progress: person ? person.steps.filter((each) => each.is_done).length / person.steps.length : 0,
    };
    if (!person) return { ...base, screen: "waiting" };
    if (!step) return { ...base, screen: "end" };
    if (step.kind === "instruction") return { ...base, screen: "instruction", markdown: INSTRUCTIONS[step.text][language] };
    if (step.kind === "break") return { ...base, screen: "break", rest_s: Math.max(0, (this.break_end_ms - Date.now()) / 1000) };
    if (step.kind === "form") return { ...base, screen: "form", form: this.form(FORMS[step.form], step.form) };
    if (this.phase !== "running" && this.phase !== "starting") return { ...base, screen: "waiting" };
    const link = this.hand === "mouse" ? this.run?.link ?? null : null;
    return { ...base, screen: "trial", link, task: DOOR[language], is_practice: step.kind === "practice" };
  }

  form({ kind, about, items, pairs }, name) {
    const { language } = this;
    return {
      name, kind, about: about?.[language] ?? "", pairs,
      items: items.map((item) => ({ ...item, text: item.text[language], ends: item.ends.map((end) => end[language]) })),
    };
  }

  // What comes after a step.
  arrive() {
    const { step } = this;
    this.problem = null;
    if (!step) {
      this.person.status = "complete";
      this.phase = "complete";
      return;
    }
    if (step.kind === "break") this.break_end_ms = Date.now() + 1000 * this.rest_s;
    this.phase = PARTICIPANT_STEPS.includes(step.kind) ? "participant" : "ready";
  }

  obey(page, command, content) {
    if (page === "participant") return this.obey_participant(command, content);
    if (!this.can().includes(command)) return `${command}: not possible now`;
    this[`do_${command}`](content);
    return null;
  }

  obey_participant(command, { language, position, answers, pairs }) {
    if (command === "language") {
      this.language = language;
      return null;
    }
    if (position !== this.position) return `position ${position}, expected ${this.position}`;
    if (command === "answers") {
      if (this.refuse_next) {
        const problem = this.refuse_next;
        this.refuse_next = null;
        return problem;
      }
      const form = FORMS[this.step.form];
      const missing = form.items.find(({ name }) => !(name in answers));
      if (missing) return `${missing.name}: missing`;
      const wanted = form.pairs.map((pair) => pair.join("/")).sort();
      if (JSON.stringify(Object.keys(pairs).sort()) !== JSON.stringify(wanted)) return "pairs: not those that were asked";
      this.saved.push({ form: this.step.form, answers, pairs });
    }
    this.step.is_done = true;
    this.arrive();
    return null;
  }

  do_begin({ code }) {
    this.participant = code;
    this.person.status = "begun";
    this.last = null;
    this.arrive();
  }
  do_leave() {
    this.participant = null;
    this.phase = "closed";
  }
  do_go_on() {
    this.step.is_done = true;
    this.arrive();
  }
  do_start() {
    this.problem = null;
    this.run = {
      link: `http://127.0.0.1:${this.run_port}/#token=ab`, mode: "armed", is_held: false, time_s: 0, force_N: 0, fault: null,
      events: [], expected_events: ["touch", "handle pressed", "door open", "walked through"],
    };
    this.phase = "starting";
    this.timer = setInterval(() => this.live(), 100);
  }
  live() {
    const { run } = this;
    if (!run) return;
    run.time_s = Number((run.time_s + 0.2).toFixed(3));
    run.force_N = Math.abs(18 + 16 * Math.sin(run.time_s) + 3 * Math.sin(5 * run.time_s));
    if (this.phase === "starting") {
      this.phase = "running";
      run.mode = "running";
      run.is_held = true;
      this.send_state();
    }
    const due = Math.min(run.expected_events.length - 1, Math.floor(run.time_s / 0.6));
    if (due > run.events.length) run.events.push({ time_s: run.time_s, name: run.expected_events[run.events.length] });
    for (const socket of this.sockets.operator) socket.send(JSON.stringify({ kind: "live", run }));
  }
  stop_run() {
    clearInterval(this.timer);
    this.run = null;
  }
  do_end() {
    const { condition, repetition } = this.step;
    this.stop_run();
    this.last = {
      condition, repetition, exit_code: 1, excluded: "", missing_events: ["closed"],
      measures: { time_s: { value: null, unit: "s", why: "event 'closed' is missing" }, peak_force_N: { value: 37.74, unit: "N", why: "" }, path_length_m: { value: 2.931, unit: "m", why: "" }, checkpoints: { value: 3, unit: "", why: "" } },
    };
    this.step.is_done = true;
    this.arrive();
  }
  do_abort({ why }) {
    this.whys.push(why);
    this.stop_run();
    this.phase = "ready";
  }
  do_repeat({ why }) {
    this.whys.push(why);
    const done = this.person.steps.filter(({ kind, is_done }) => is_done && (kind === "trial" || kind === "practice"));
    done.at(-1).is_done = false;
    this.last = null;
    this.arrive();
  }
  do_note({ text }) {
    this.notes.push({ step: this.position, text });
  }
  do_stop() {
    this.stops += 1;
    this.stop_run();
    this.phase = "failed";
    this.problem = "The run was stopped by the operator: no result.";
  }
}

// Leads the mock to the first step of `kind`.
export function lead_to(mock, kind, form = null) {
  mock.reset();
  mock.do_begin({ code: "P01" });
  for (const step of mock.person.steps) {
    if (step.kind === kind && (form === null || step.form === form)) break;
    step.is_done = true;
  }
  mock.arrive();
  mock.send_state();
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const mock = new Mock(process.argv[2]);
  console.log(await mock.listen());
}
