// The experimenter's page: whenever the study has changed, what it says is changed, and nothing else is touched:
// selected text, focus and how far a table is scrolled stay.

const live = document.getElementById("live");
const lost = document.getElementById("lost");
const changes = new EventSource(live.dataset.url);

changes.onmessage = ({ data }) => {
  const sent = document.createElement("template");
  sent.innerHTML = data; // made by the same template as the page, with everything escaped
  updateWithin(live, sent.content);
};
changes.onopen = () => { lost.textContent = ""; };
changes.onerror = () => { lost.textContent = lost.dataset.text; };

/** Make what is within an element as it is within another. Who has an id keeps its element wherever it stands. */
function updateWithin(shown, wanted) {
  for (const child of [...shown.children]) {
    if (child.id && ![...wanted.children].some(({ id }) => id === child.id)) child.remove();
  }
  let place = shown.firstChild;
  for (const next of [...wanted.childNodes]) {
    const same = next.id ? [...shown.children].find(({ id }) => id === next.id) : place;
    if (same && same.nodeName === next.nodeName && (same.id ?? "") === (next.id ?? "")) {
      if (same !== place) shown.insertBefore(same, place);
      update(same, next);
      place = same.nextSibling;
    } else {
      shown.insertBefore(next, place);
    }
  }
  while (place) {
    const gone = place;
    place = place.nextSibling;
    gone.remove();
  }
}

function update(shown, wanted) {
  if (shown.isEqualNode(wanted)) return;
  if (!(shown instanceof Element)) {
    shown.data = wanted.data;
    return;
  }
  for (const { name } of [...shown.attributes]) if (!wanted.hasAttribute(name)) shown.removeAttribute(name);
  for (const { name, value } of wanted.attributes) if (shown.getAttribute(name) !== value) shown.setAttribute(name, value);
  updateWithin(shown, wanted);
}
