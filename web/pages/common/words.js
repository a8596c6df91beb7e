// The page's words in the user's language: the one that was chosen last, otherwise the browser's,
// otherwise English.
import {kLanguages} from './languages.js';  // code -> name; web/words.py writes it

const all = {};  // code -> words
let language = 'en';
// What is said while the words are not there, for example because the host has gone.
const kFirst = {
  loading: 'Loading',
  broken: 'The page has stopped: {}. Load it again.',
  no_module: 'This browser cannot run the page: it lacks WebAssembly with SIMD. Update it.',
};

export async function load() {
  const wanted = [new URLSearchParams(location.search).get('language'), stored(), ...navigator.languages];
  language = wanted.map((one) => (one ?? '').slice(0, 2)).find((one) => one in kLanguages) ?? 'en';
  document.documentElement.lang = language;
  await take(language);
}
// So that another language can be chosen later without a request.
export const load_others = () => Promise.all(Object.keys(kLanguages).map(take));
async function take(code) {
  if (code in all) return;
  const answer = await fetch(new URL(`../words/${code}.json`, import.meta.url));
  if (!answer.ok) throw new Error(`words/${code}.json: ${answer.status}`);
  all[code] = await answer.json();
}

// word('not_kept', 'why')
export function word(key, ...parts) {
  const text = all[language]?.[key] ?? all.en?.[key] ?? kFirst[key] ?? '';  // never a bare key
  return text.replace(/\{[^}]*\}/g, (gap) => parts.shift() ?? gap);
}
export const languages = () => Object.entries(kLanguages).map(([code, name]) => ({code, name}));
export const present = () => language;
export async function choose(code) {
  if (!(code in all)) await take(code);
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
