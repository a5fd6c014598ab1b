// One clip: an explicit Play button, no seeking, and a true record of what was played.

const ENOUGH = 0.98; // of the duration; the server asks for the same
const SLACK_S = 0.15; // by which the clip's clock may run ahead of the wall clock between two looks

export class Player {
  #video;
  #button;
  #status;
  #figure;
  #lapse;
  #texts;
  #place = 0; // where in the clip we last looked, s
  #looked = 0; // when, ms
  #playedNow = 0; // in the present play, s
  #playing = false;
  #loaded = false;
  #allowed = false;
  #broken = false;
  #replays; // how often it may be played again after the first full view; null for any number

  constructor(figure, clip, { texts, replays }) {
    this.clip = clip;
    this.#texts = texts;
    this.#replays = replays;
    this.#figure = figure;
    this.#video = figure.querySelector("video");
    this.#button = figure.querySelector("button");
    this.#status = figure.querySelector("[role=status]");
    this.#lapse = figure.querySelector("progress");
    this.record = {
      role: clip.role, plays: 0, starts: 0, played_s: 0, duration_s: 0,
      frames: 0, dropped: 0, streamed: false, happenings: [],
    };
    this.onplay = () => {};
    this.onfull = () => {};
    this.onfailure = () => {};
    this.onretry = () => {};
    this.#listen();
  }

  get seen() { return this.record.plays > 0; }

  get #spent() { return this.#replays !== null && this.record.plays > this.#replays; }

  /** Say how much of the clip has come, from 0 to 1. */
  progress(share) {
    if (!this.#loaded) this.#button.textContent = `${this.#texts.loading} ${Math.floor(100 * share)} %`;
  }

  /** Give it the loaded clip. */
  load({ url, streamed }) {
    this.record.streamed = streamed;
    this.#video.src = url;
    this.#video.load();
    this.#setBroken(false);
    this.#loaded = true;
    this.#offer();
  }

  /** From now on it may be played. */
  allow() {
    this.#allowed = true;
    this.#offer();
  }

  #offer() {
    if (this.seen) return;
    this.#button.hidden = false;
    this.#button.disabled = !(this.#allowed && this.#loaded);
    this.#button.textContent = this.#loaded ? this.#texts.play : this.#texts.loading;
  }

  stop() { this.#video.pause(); }

  async #play() {
    this.onplay(this);
    if (this.#video.currentTime === 0 || this.#video.ended) this.record.starts += 1;
    this.#looked = performance.now(); // the first frames may be shown before "playing" is heard
    try {
      await this.#video.play();
    } catch (error) {
      this.#note(`refused ${error.name}`);
      this.#say(this.#texts.press);
    }
  }

  #listen() {
    const video = this.#video;
    const on = (name, then) => video.addEventListener(name, () => { this.#note(name); then?.(); });
    this.#button.addEventListener("click", () => (this.#broken ? this.onretry(this) : this.#play()));
    on("loadeddata", () => { this.record.duration_s = video.duration; });
    on("playing", () => {
      this.#playing = true;
      this.#button.hidden = true;
      this.#say("");
      this.#countFrames();
    });
    on("pause", () => { this.#look(); this.#playing = false; this.#offerToContinue(); });
    on("waiting", () => this.#say(this.#texts.waiting));
    on("seeking", () => this.#refuseSeek());
    video.addEventListener("ratechange", () => {
      this.#note(`rate ${video.playbackRate}`);
      if (video.playbackRate !== 1) video.playbackRate = 1;
    });
    on("ended", () => this.#ended());
    on("error", () => this.fail(this.#video.error?.message || "unknown error"));
    video.addEventListener("timeupdate", () => this.#look());
    video.addEventListener("contextmenu", (event) => event.preventDefault()); // browsers offer controls there
    document.addEventListener("visibilitychange", () => {
      this.#note(document.visibilityState);
      if (document.hidden && this.#playing) video.pause();
    });
  }

  /** Add what was truly played since the last look. A jump or a faster clock adds nothing. */
  #look() {
    if (!this.#playing) return;
    const now = performance.now();
    const step = this.#video.currentTime - this.#place;
    const wall = (now - this.#looked) / 1000;
    if (step > 0 && step <= wall + SLACK_S) this.#playedNow += step;
    this.#place = this.#video.currentTime;
    this.#looked = now;
    this.#lapse.value = this.#place / this.#video.duration;
  }

  #countFrames() {
    if (!("requestVideoFrameCallback" in this.#video)) return;
    this.#video.requestVideoFrameCallback(() => {
      this.#look();
      if (this.record.frames === 0) this.#note("first frame");
      if (!this.seen) this.record.frames += 1;
      if (this.#playing) this.#countFrames();
    });
  }

  #refuseSeek() {
    const replay = this.#video.currentTime === 0;
    if (replay || Math.abs(this.#video.currentTime - this.#place) < SLACK_S) return;
    this.#note("seek refused");
    this.#video.currentTime = this.#place;
  }

  #ended() {
    this.#look();
    this.#playing = false;
    this.#place = 0;
    const full = this.#playedNow >= ENOUGH * this.#video.duration;
    const first = full && !this.seen;
    if (first) {
      this.record.played_s = Math.min(this.#playedNow, this.#video.duration);
      this.record.dropped = this.#video.getVideoPlaybackQuality?.().droppedVideoFrames ?? 0;
    }
    if (full) this.record.plays += 1;
    this.#playedNow = 0;
    this.#button.hidden = this.#spent;
    this.#button.textContent = this.#texts.again;
    this.#button.classList.toggle("again", full);
    const watched = this.#spent && this.#replays > 0 ? this.#texts.last : this.#texts.watched;
    this.#say(full ? watched : this.#texts.incomplete);
    if (first) this.onfull(this);
  }

  #offerToContinue() {
    if (this.#video.ended) return;
    this.#button.hidden = false;
    this.#button.textContent = this.#texts.continue;
  }

  /** Say that it cannot be played, and offer another try. */
  fail(why) {
    this.#playing = false;
    this.#setBroken(true);
    this.#button.hidden = this.#button.disabled = false;
    this.#button.textContent = this.#texts.retry;
    this.onfailure(this, why);
  }

  #setBroken(broken) {
    this.#broken = broken;
    this.#figure.classList.toggle("broken", broken);
    this.#say(broken ? this.#texts.failed : "");
  }

  #say(text) { this.#status.textContent = text; }

  #note(name) {
    if (this.record.happenings.length >= 400) return;
    this.record.happenings.push({ at_ms: performance.now(), name, media_s: this.#video.currentTime });
  }
}
