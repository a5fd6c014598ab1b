// Answers wait here until the server has stored them: in localStorage, so that closing the browser loses nothing.

const FIRST_WAIT_MS = 1000;
const LONGEST_WAIT_MS = 30000;

export class Outbox {
  #key;
  #address;
  #busy = null;

  /** `onstate(state)` hears "sending", "waiting" (for the network), "blocked" (on the way there) and "empty". */
  constructor(participant, address, onstate) {
    this.#key = `outbox:${participant}`;
    this.#address = address;
    this.onstate = onstate;
    addEventListener("online", () => this.#wake?.());
  }

  #wake = null;

  #unstored = null; // what the browser refuses to store, as some apps' own browsers do: kept while the page is open

  get #waiting() {
    try {
      return this.#unstored ?? JSON.parse(localStorage.getItem(this.#key) ?? "[]");
    } catch {
      return [];
    }
  }

  set #waiting(submissions) {
    try {
      localStorage.setItem(this.#key, JSON.stringify(submissions));
      this.#unstored = null;
    } catch {
      this.#unstored = submissions;
    }
  }

  get empty() { return this.#waiting.length === 0; }

  /** Keep a submission and send everything kept. Resolves to the server's last word: {ok, status, reason}. */
  send(submission) {
    this.#waiting = [...this.#waiting, submission];
    return this.flush();
  }

  /** Send everything kept, oldest first, for as long as it takes. */
  flush() {
    this.#busy ??= this.#sendAll().finally(() => { this.#busy = null; });
    return this.#busy;
  }

  async #sendAll() {
    let word = { ok: true };
    for (let wait = FIRST_WAIT_MS; !this.empty; ) {
      const [submission] = this.#waiting;
      if (wait === FIRST_WAIT_MS) this.onstate("sending");
      word = await this.#post(submission);
      if (word.again) {
        this.onstate(word.blocked ? "blocked" : "waiting");
        await this.#sleep(wait);
        wait = Math.min(2 * wait, LONGEST_WAIT_MS);
      } else {
        this.#waiting = this.#waiting.filter((kept) => kept.id !== submission.id);
        wait = FIRST_WAIT_MS;
      }
    }
    this.onstate("empty");
    return word;
  }

  /** What is not JSON is not from the study but from a proxy or a login page before it: no word on the answer. */
  async #post(submission) {
    try {
      const response = await fetch(this.#address, {
        method: "POST",
        headers: { "Content-Type": "application/json" },
        body: JSON.stringify(submission),
      });
      const body = await response.json().catch(() => null);
      const busy = response.status >= 500 || response.status === 429 || response.status === 408;
      const blocked = body === null && !busy;
      return { ok: response.ok, status: response.status, reason: body?.reason, again: busy || blocked, blocked };
    } catch {
      return { ok: false, again: true };
    }
  }

  #sleep(ms) {
    return new Promise((resolve) => {
      this.#wake = resolve;
      setTimeout(resolve, ms);
    });
  }
}
