// Clips are loaded whole before they may be played, so that a poor network never shows as a stutter.

const TRIES = 4;
const FIRST_WAIT_MS = 500;

const pause = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

/** What came is not what was rendered: it must not be judged. */
export class Altered extends Error {}

/**
 * Load a clip whole. Resolves to {url, streamed}; after several failures to its address, to be streamed, or
 * rejects with Altered. `progress` hears the share that has come, `failed` why a try failed.
 */
export async function loadClip(clip, { progress, failed }) {
  let last;
  for (let attempt = 0; attempt < TRIES; attempt += 1) {
    try {
      const response = await fetch(clip.url, { cache: attempt ? "reload" : "default" }); // a kept copy may be the fault
      if (!response.ok) throw new Error(`HTTP ${response.status}`);
      const blob = await readAll(response, (bytes) => progress(bytes / clip.size));
      if (blob.size !== clip.size) throw new Error(`${blob.size} of ${clip.size} bytes`);
      if (!clip.url.includes(await nameOf(blob))) throw new Altered("other bytes than were sent");
      return { url: URL.createObjectURL(blob), streamed: false };
    } catch (error) {
      last = error;
      failed(`${clip.role}: ${error.message}`);
      await pause(FIRST_WAIT_MS * 2 ** attempt);
    }
  }
  if (last instanceof Altered) throw last;
  return { url: clip.url, streamed: true };
}

/** By which a clip is called: the beginning of its hash. "" where a browser does not compute any, for want of HTTPS. */
async function nameOf(blob) {
  if (!crypto.subtle) return "";
  const bytes = new Uint8Array(await crypto.subtle.digest("SHA-256", await blob.arrayBuffer()));
  return [...bytes.subarray(0, 16)].map((byte) => byte.toString(16).padStart(2, "0")).join("");
}

async function readAll(response, heard) {
  const chunks = [];
  let bytes = 0;
  for (const reader = response.body.getReader(); ; ) {
    const { done, value } = await reader.read();
    if (done) return new Blob(chunks, { type: "video/mp4" });
    chunks.push(value);
    heard((bytes += value.length));
  }
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
