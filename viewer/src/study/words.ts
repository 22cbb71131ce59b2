// Words of the participant's page. Texts of the study itself come in the chosen language.

const ENGLISH = {
  continue: "Continue",
  back: "Back",
  language: "Language",
  progress: "Progress",
  lost: "The connection is lost. Nothing that you have entered is gone. Trying again\u2026",
  again: "The connection is back.",
  no_token: "Please open the whole link that the study program has printed: it has a secret in it.",
  waiting: "Please wait",
  waiting_text: "It goes on by itself as soon as the operator is ready.",
  waiting_first: "Choose your language. It goes on by itself as soon as the operator is ready.",
  instruction: "Instructions",
  trial: "Use the handle now",
  practice: "Practice: use the handle now",
  device: "You can let go at any time. It ends by itself, or the operator tells you.",
  mouse: "Drag the handle in the picture. STOP in it, or Esc, stops everything at once.",
  picture: "The handle, to be moved with mouse or finger",
  break: "Break",
  break_text: "Have a rest. You can continue when the time is over.",
  break_over: "The break is over. Continue when you are ready.",
  minutes_left: (n: number) => (n === 1 ? "1 minute left" : `${n} minutes left`),
  end: "Thank you",
  end_text: "That was all. The operator is with you in a moment.",
  nasa_tlx: "The task you have just done",
  sus: "Your impression of the system",
  own: "Questions",
  all_needed: "Please answer every question. Nothing is chosen for you beforehand.",
  tlx_hint: "Touch each scale where it fits, or use the arrow keys.",
  likert_hint: "Choose one number in each row, or type it on the keyboard.",
  no_names: "If you like. Please write no names.",
  not_answered: "not answered",
  needed: "This answer is missing.",
  missing: (n: number) => (n === 1 ? "One answer is missing." : `${n} answers are missing.`),
  between: (value: string, low: string, high: string) =>
    low === "" && high === "" ? value : `${value}, from ${low} to ${high}`,
  send: "Send answers",
  sending: "Sending\u2026",
  refused: (problem: string) => `The answers were not accepted: ${problem}`,
  not_sent: "The answers could not be sent. They are kept here: please send them again.",
  not_done: "That did not arrive. Please press it again.",
  pair: "Which mattered more for your workload?",
  pair_count: (n: number, of: number) => `Comparison ${n} of ${of}`,
  pair_hint: "Keys: 1 or 2",
  pairs_done: "All compared",
  pairs_done_text: "Send your answers, or go back to change them.",
};

export type Words = typeof ENGLISH;

const GERMAN: Words = {
  continue: "Weiter",
  back: "Zur\u00fcck",
  language: "Sprache",
  progress: "Fortschritt",
  lost: "Die Verbindung ist unterbrochen. Ihre Eingaben bleiben erhalten. Neuer Versuch\u2026",
  again: "Die Verbindung ist wieder da.",
  no_token:
    "Bitte \u00f6ffnen Sie den ganzen Link, den das Studienprogramm ausgegeben hat: Er enth\u00e4lt ein Geheimnis.",
  waiting: "Bitte warten Sie",
  waiting_text: "Es geht von selbst weiter, sobald die Versuchsleitung bereit ist.",
  waiting_first: "W\u00e4hlen Sie Ihre Sprache. Es geht von selbst weiter, sobald die Versuchsleitung bereit ist.",
  instruction: "Anleitung",
  trial: "Benutzen Sie jetzt den Griff",
  practice: "\u00dcbung: Benutzen Sie jetzt den Griff",
  device: "Sie k\u00f6nnen jederzeit loslassen. Es endet von selbst, oder die Versuchsleitung sagt es Ihnen.",
  mouse: "Ziehen Sie den Griff im Bild. STOP darin oder Esc h\u00e4lt sofort alles an.",
  picture: "Der Griff, mit Maus oder Finger zu bewegen",
  break: "Pause",
  break_text: "Ruhen Sie sich aus. Sie k\u00f6nnen weitermachen, wenn die Zeit um ist.",
  break_over: "Die Pause ist zu Ende. Machen Sie weiter, wenn Sie bereit sind.",
  minutes_left: (n) => (n === 1 ? "noch 1 Minute" : `noch ${n} Minuten`),
  end: "Vielen Dank",
  end_text: "Das war alles. Die Versuchsleitung ist gleich bei Ihnen.",
  nasa_tlx: "Die Aufgabe, die Sie gerade erledigt haben",
  sus: "Ihr Eindruck vom System",
  own: "Fragen",
  all_needed: "Bitte beantworten Sie jede Frage. Nichts ist vorausgew\u00e4hlt.",
  tlx_hint: "Ber\u00fchren Sie jede Skala an der passenden Stelle, oder nutzen Sie die Pfeiltasten.",
  likert_hint: "W\u00e4hlen Sie in jeder Zeile eine Zahl, oder tippen Sie sie auf der Tastatur.",
  no_names: "Wenn Sie m\u00f6chten. Bitte schreiben Sie keine Namen.",
  not_answered: "nicht beantwortet",
  needed: "Diese Antwort fehlt.",
  missing: (n) => (n === 1 ? "Eine Antwort fehlt." : `${n} Antworten fehlen.`),
  between: (value, low, high) =>
    low === "" && high === "" ? value : `${value}, von ${low} bis ${high}`,
  send: "Antworten senden",
  sending: "Wird gesendet\u2026",
  refused: (problem) => `Die Antworten wurden nicht angenommen: ${problem}`,
  not_sent:
    "Die Antworten konnten nicht gesendet werden. Sie bleiben hier erhalten: Bitte senden Sie sie noch einmal.",
  not_done: "Das ist nicht angekommen. Bitte dr\u00fccken Sie noch einmal.",
  pair: "Was hat mehr zu Ihrer Beanspruchung beigetragen?",
  pair_count: (n, of) => `Vergleich ${n} von ${of}`,
  pair_hint: "Tasten: 1 oder 2",
  pairs_done: "Alles verglichen",
  pairs_done_text: "Senden Sie Ihre Antworten, oder gehen Sie zur\u00fcck, um sie zu \u00e4ndern.",
};

const NAMES: Record<string, string> = { en: "English", de: "Deutsch" };

// In English where the page has no words of that language.
export function words_of(language: string): Words {
  return language.startsWith("de") ? GERMAN : ENGLISH;
}

// A language in its own words.
export function language_name(language: string): string {
  return NAMES[language] ?? language;
}
