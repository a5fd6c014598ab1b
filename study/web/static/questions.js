// What questions need beyond HTML: sliders without a mark until one is made, and ranks that are given once.

export function enliven(form) {
  form.querySelectorAll(".slider").forEach(makeSlider);
  form.querySelectorAll(".rank").forEach(makeRanking);
}

/** A range has a value from the start; the answer is what was set, kept in the named field beside it. */
function makeSlider(row) {
  const range = row.querySelector("input[type=range]");
  const answer = row.querySelector("input[name]");
  const set = () => {
    range.classList.remove("unset");
    answer.value = range.value;
    answer.dispatchEvent(new Event("input", { bubbles: true }));
  };
  range.addEventListener("input", (event) => { event.stopPropagation(); set(); });
  range.addEventListener("click", set); // a mark in the very middle changes nothing
  range.addEventListener("keydown", (event) => {
    if (event.key !== " " && event.key !== "Enter") return;
    event.preventDefault();
    set();
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
