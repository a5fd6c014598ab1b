// Clips are loaded whole before they may be played, so that a poor network never shows as a stutter.

const TRIES = 4;
const FIRST_WAIT_MS = 500;

const pause = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

/** Load a clip whole. Resolves to {url, streamed}; after several failures to its address, to be streamed. */
export async function loadClip(clip, onFailure) {
  for (let attempt = 0; attempt < TRIES; attempt += 1) {
    try {
      const response = await fetch(clip.url);
      if (!response.ok) throw new Error(`HTTP ${response.status}`);
      const blob = await response.blob();
      if (blob.size !== clip.size) throw new Error(`${blob.size} of ${clip.size} bytes`);
      return { url: URL.createObjectURL(blob), streamed: false };
    } catch (error) {
      onFailure(`${clip.role}: ${error.message}`);
      await pause(FIRST_WAIT_MS * 2 ** attempt);
    }
  }
  return { url: clip.url, streamed: true };
}

/** Fetch what comes next into the browser's cache; it is served as immutable, so the next page finds it there. */
export async function fetchAhead(urls) {
  for (const url of urls) {
    try {
      await (await fetch(url, { priority: "low" })).blob();
    } catch {
      return; // the next page tries again, and says so
    }
  }
}
