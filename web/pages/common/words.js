// The page's words in the user's language: the one that was chosen last, otherwise the browser's,
// otherwise English.
let all = {};
let language = 'en';
// What is said while the words are not there, for example because the host has gone.
const kFirst = {
  loading: 'Loading',
  broken: 'The page has stopped: {}. Load it again.',
  no_module: 'This browser cannot run the page: it lacks WebAssembly with SIMD. Update it.',
};

export async function load() {
  const answer = await fetch(new URL('../words.json', import.meta.url));
  if (!answer.ok) throw new Error(`words.json: ${answer.status}`);
  all = await answer.json();
  const wanted = [new URLSearchParams(location.search).get('language'), stored(), ...navigator.languages];
  language = wanted.map((one) => (one ?? '').slice(0, 2)).find((one) => one in all) ?? 'en';
  document.documentElement.lang = language;
}

// word('left_out', 12)
export function word(key, ...parts) {
  const text = all[language]?.[key] ?? all.en?.[key] ?? kFirst[key] ?? '';  // never a bare key
  return text.replace(/\{[^}]*\}/g, (gap) => parts.shift() ?? gap);
}
export const languages = () => Object.entries(all).map(([code, words]) => ({code, name: words.name}));
export const present = () => language;
export function choose(code) {
  language = code;
  document.documentElement.lang = code;
  try {
    localStorage.setItem('burr.language', code);
  } catch { /* not kept */ }
}
// "12 s", "3 min 20 s"
export const duration = (seconds) => (seconds < 60 ? `${number(seconds, 0)} s` : `${Math.floor(seconds / 60)} min ${number(Math.floor(seconds % 60), 0)} s`);
export const number = (value, digits) =>
    value.toLocaleString(language, {minimumFractionDigits: digits, maximumFractionDigits: digits});

function stored() {
  try {
    return localStorage.getItem('burr.language');
  } catch {
    return null;
  }
}
