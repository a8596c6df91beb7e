// Says what a browser withholds from a page that came over plain http, as from a computer of the house by its name; this computer itself
// counts as safe. Nothing else of the page needs https: it has one thread and shares no memory.
import * as words from './words.js';

const kWithheld = {
  http_sound: () => !('audioWorklet' in (window.AudioContext ?? Object).prototype),
  http_storage: () => !navigator.storage?.getDirectory && !window.indexedDB,
  http_offline: () => !navigator.serviceWorker,
};

export const missing = () => Object.keys(kWithheld).filter((key) => kWithheld[key]());

async function tell() {
  const look = document.createElement('link');
  look.rel = 'stylesheet';
  look.href = new URL('plain_http.css', import.meta.url);
  document.head.append(look);
  await words.load();
  const note = document.createElement('aside'), text = document.createElement('p'), close = document.createElement('button');
  note.id = 'plain_http';
  close.type = 'button';
  const speak = () => {
    text.textContent = words.word('http_plain', missing().map((key) => words.word(key)).join(', '));
    close.textContent = words.word('own_close');
    note.setAttribute('aria-label', text.textContent);
  };
  speak();
  document.getElementById('language')?.addEventListener('change', () => setTimeout(speak));
  close.addEventListener('click', () => note.remove());
  note.append(text, close);
  document.body.append(note);
}

if (!isSecureContext && missing().length > 0) tell().catch((trouble) => console.error(trouble));
