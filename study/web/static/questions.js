// What questions need beyond HTML: sliders without a mark until one is made, and ranks that are given once.

export function enliven(form) {
  form.querySelectorAll(".slider").forEach(makeSlider);
  form.querySelectorAll(".rank").forEach(makeRanking);
}

/** A range has a value from the start; the answer is what was set, kept in the named field beside it. */
function makeSlider(row) {
  const range = row.querySelector("input[type=range]");
  const answer = row.querySelector("input[name]");
  const set = (...heard) => {
    range.classList.remove("unset");
    answer.value = range.value;
    for (const name of heard) answer.dispatchEvent(new Event(name, { bubbles: true }));
  };
  range.addEventListener("input", () => set("input"));
  range.addEventListener("change", () => set("change")); // let go of
  range.addEventListener("click", () => set("input", "change")); // a mark in the very middle changes nothing
  range.addEventListener("keydown", (event) => {
    if (event.key !== " " && event.key !== "Enter") return;
    event.preventDefault();
    set("input", "change");
  });
  answer.addEventListener("focus", () => range.focus());
}

function makeRanking(question) {
  question.addEventListener("change", ({ target }) => {
    for (const other of question.querySelectorAll("input:checked")) {
      if (other !== target && other.value === target.value) other.checked = false;
    }
  });
}
