// The experimenter's page: its live part is replaced whenever the server says that something has changed.

const live = document.getElementById("live");
const lost = document.getElementById("lost");
const changes = new EventSource(live.dataset.url);

changes.onmessage = ({ data }) => {
  const scrolled = live.querySelector(".scroll")?.scrollLeft ?? 0;
  live.innerHTML = data; // made by the same template as the page, with everything escaped
  live.querySelector(".scroll")?.scrollTo(scrolled, 0);
};
changes.onopen = () => { lost.textContent = ""; };
changes.onerror = () => { lost.textContent = lost.dataset.text; };
