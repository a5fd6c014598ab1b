// One page of the session: clips first, then answers, then the outbox; afterwards the server says what comes next.

import { Answers } from "./answers.js";
import { Altered, fetchAhead, loadClip } from "./clips.js";
import { Outbox } from "./outbox.js";
import { Player } from "./player.js";
import { enliven } from "./questions.js";

const page = JSON.parse(document.getElementById("page").textContent);
const form = document.getElementById("answers");
const proceed = document.getElementById("continue");
const notice = document.getElementById("notice");
const gate = document.getElementById("gate");
const answers = new Answers(form);
const opened = performance.now();
let players = [];
enliven(form);
document.getElementById("late").remove();

const outbox = new Outbox(page.participant, page.answer_url, (state) => {
  if (state === "waiting") say(page.texts.offline);
  if (state === "blocked") say(page.texts.blocked, true);
  if (state === "empty") say("");
});

function say(text, alarm = false) {
  notice.textContent = text;
  notice.classList.toggle("alarm", alarm);
}

function report(name, detail) {
  const body = JSON.stringify({ name, detail: String(detail).slice(0, 500) });
  fetch(page.event_url, { method: "POST", headers: { "Content-Type": "application/json" }, body, keepalive: true })
    .catch(() => {}); // only a note; the answers have their own way
}

/** Ask the server for the page that is due; it takes this one's place in the browser's history. */
const move = () => location.replace(page.next_url);

async function preparePlayers() {
  const figures = [...document.querySelectorAll("figure.player")];
  players = page.clips.map((clip, index) => new Player(figures[index], clip, page));
  players.forEach((player, index) => {
    player.onplay = (playing) => players.filter((other) => other !== playing).forEach((other) => other.stop());
    player.onfull = () => {
      players[index + 1]?.allow();
      if (players.every(({ seen }) => seen)) unlock();
    };
    player.onfailure = (_, why) => report("video_failed", `${page.step} ${player.clip.role}: ${why}`);
    player.onretry = () => fill(player);
  });
  players[0].allow();
  await Promise.all(players.map(fill));
}

async function fill(player) {
  const failed = (why) => report("video_retried", `${page.step} ${why}`);
  try {
    player.load(await loadClip(player.clip, { progress: (share) => player.progress(share), failed }));
  } catch (error) {
    if (!(error instanceof Altered)) throw error;
    player.fail(error.message);
  }
}

function unlock() {
  const questions = form.querySelector("fieldset.questions");
  if (questions) questions.disabled = false;
  if (gate) gate.textContent = "";
  proceed.disabled = false;
  answers.start();
}

function firstMissing() {
  const item = answers.items.find((name) => {
    const field = form.elements[name];
    const one = field instanceof RadioNodeList ? field[0] : field;
    return one.required && !new FormData(form).get(name)?.trim(); // spaces are no answer
  });
  for (const row of form.querySelectorAll("[data-item]")) row.classList.toggle("missing", row.dataset.item === item);
  return item && form.querySelector(`[name="${CSS.escape(item)}"]`);
}

form.addEventListener("submit", async (event) => {
  event.preventDefault();
  if (proceed.disabled) return; // a double click
  const missing = firstMissing();
  if (missing) {
    say(page.texts.missing, true);
    missing.focus();
    return;
  }
  const invalid = [...form.elements].find((element) => !element.validity.valid);
  if (invalid) {
    say(invalid.dataset.wanted ?? invalid.validationMessage, true);
    invalid.focus();
    return;
  }
  proceed.disabled = true;
  say("");
  await sendAndMove({
    id: newId(),
    step: page.step,
    answers: answers.read(),
    views: players.map(({ record }) => record),
    on_page_ms: performance.now() - opened,
  });
});

async function sendAndMove(submission) {
  const word = await (submission ? outbox.send(submission) : outbox.flush());
  if (word.ok || word.status === 409) move();
  else {
    say(`${page.texts.refused} ${word.reason ?? ""}`, true);
    report("answer_refused", word.reason ?? word.status);
  }
}

/** A random UUID, also where the page is not served over HTTPS and crypto.randomUUID is missing. */
function newId() {
  const bytes = crypto.getRandomValues(new Uint8Array(16));
  bytes[6] = (bytes[6] & 0x0f) | 0x40;
  bytes[8] = (bytes[8] & 0x3f) | 0x80;
  const hex = [...bytes].map((byte) => byte.toString(16).padStart(2, "0")).join("");
  return [hex.slice(0, 8), hex.slice(8, 12), hex.slice(12, 16), hex.slice(16, 20), hex.slice(20)].join("-");
}

addEventListener("pageshow", (event) => {
  if (event.persisted) move(); // brought back by the back button: the server knows better what is due
});

if (!outbox.empty) {
  await sendAndMove(null); // left over from before the browser was closed
} else {
  if (page.clips.length) await preparePlayers();
  else unlock();
  fetchAhead(page.ahead);
}
