// The form's answers with their times: when each item was last touched, and how often its answer was replaced.
// What is typed is an answer once the field is left; until then nothing was replaced.

export class Answers {
  #form;
  #origin = null;
  #touched = new Map(); // item -> when, in ms
  #answered = new Map(); // item -> {value, changes}

  constructor(form) {
    this.#form = form;
    form.addEventListener("input", ({ target }) => target.name && this.#touch(target.name));
    form.addEventListener("change", ({ target }) => target.name && this.#answer(target.name));
  }

  /** Reaction times count from now: the end of the first full view. */
  start() { this.#origin = performance.now(); }

  #touch(item) {
    this.#touched.set(item, this.#origin === null ? null : performance.now() - this.#origin);
  }

  #answer(item) {
    const before = this.#answered.get(item);
    const value = this.#value(item);
    if (value === (before?.value ?? "")) return;
    this.#answered.set(item, { value, changes: before ? before.changes + 1 : 0 });
  }

  /** "" where nothing is answered. Several ticks of one item are joined by ";"; 34 may also be typed as 3.4e1. */
  #value(item) {
    const field = this.#form.elements[item];
    if (field.type === "number") return Number.isNaN(field.valueAsNumber) ? "" : String(field.valueAsNumber);
    return new FormData(this.#form).getAll(item).join(";").trim();
  }

  /** Items in the form, each once, in the order shown. */
  get items() {
    return [...new Set([...this.#form.elements].map((element) => element.name).filter(Boolean))];
  }

  /** One entry per item. */
  read() {
    return this.items.map((item) => ({
      item,
      value: this.#value(item),
      rt_ms: this.#touched.get(item) ?? null,
      changes: this.#answered.get(item)?.changes ?? 0,
    }));
  }
}
