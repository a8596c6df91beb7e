// The page's words in the user's language: the one that was chosen last, otherwise the browser's,
// otherwise English.
let all = {};
let language = 'en';

export async function load() {
  all = await (await fetch(new URL('../words.json', import.meta.url))).json();
  const wanted = [new URLSearchParams(location.search).get('language'), stored(), ...navigator.languages];
  language = wanted.map((one) => (one ?? '').slice(0, 2)).find((one) => one in all) ?? 'en';
  document.documentElement.lang = language;
}

// word('left_out', 12)
export function word(key, ...parts) {
  let text = all[language]?.[key] ?? all.en?.[key] ?? key;
  for (const part of parts) text = text.replace(/\{[^}]*\}/, part);
  return text;
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
export const number = (value, digits) =>
    value.toLocaleString(language, {minimumFractionDigits: digits, maximumFractionDigits: digits});

function stored() {
  try {
    return localStorage.getItem('burr.language');
  } catch {
    return null;
  }
}
