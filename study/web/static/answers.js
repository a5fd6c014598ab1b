// The form's answers with their times: when each item was last changed, and how often.

export class Answers {
  #form;
  #origin = null;
  #marks = new Map(); // item -> {rt_ms, changes}

  constructor(form) {
    this.#form = form;
    form.addEventListener("input", ({ target }) => this.#mark(target.name));
  }

  /** Reaction times count from now: the end of the first full view. */
  start() { this.#origin = performance.now(); }

  #mark(item) {
    if (!item) return;
    const before = this.#marks.get(item);
    const rt = this.#origin === null ? null : performance.now() - this.#origin;
    this.#marks.set(item, { rt_ms: rt, changes: before ? before.changes + 1 : 0 });
  }

  /** Items in the form, each once, in the order shown. */
  get items() {
    return [...new Set([...this.#form.elements].map((element) => element.name).filter(Boolean))];
  }

  /** One entry per item; an item left out has the value "". Several ticks of one item are joined by ";". */
  read() {
    const data = new FormData(this.#form);
    return this.items.map((item) => ({
      item,
      value: data.getAll(item).join(";").trim(),
      ...(this.#marks.get(item) ?? { rt_ms: null, changes: 0 }),
    }));
  }
}
