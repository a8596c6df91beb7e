// What a learning management system is told of a session on the page, by cmi5 (quartz) and xAPI 1.0.3: initialized before the bone comes,
// completed when the work is declared done, terminated at the end. The same as src/burr/lrs/launch.cpp says of the desktop, so neither
// passed nor failed and no score: a person decides that, later (docs/teach/xapi.md).
const kCategory = 'https://w3id.org/xapi/cmi5/context/categories/cmi5';
const kMoveOn = 'https://w3id.org/xapi/cmi5/context/categories/moveon';
const kSession = 'https://w3id.org/xapi/cmi5/context/extensions/sessionid';
const kParts = ['endpoint', 'fetch', 'actor', 'registration', 'activityId'];
const kPatience = 20000;  // for a statement that is not answered [ms]

const kWords = {
  en: {
    begins: 'Telling the learning management system ...', runs: '', leave: 'Leave', left: 'The session has ended. You can close this page.',
    done: 'The work is done, and the course knows it.', missing: '{} is missing in the address. Start the unit from the course again.',
    refused: 'The learning management system says: {}. Start the unit from the course again.',
    lost: 'The learning management system does not answer ({}). Your work goes on; the course may not count it.',
  },
  de: {
    begins: 'Das Lernsystem wird benachrichtigt ...', runs: '', leave: 'Verlassen', left: 'Die Sitzung ist zu Ende. Sie können diese Seite schließen.',
    done: 'Die Arbeit ist fertig, und der Kurs weiß es.', missing: '{} fehlt in der Adresse. Starten Sie die Einheit noch einmal im Kurs.',
    refused: 'Das Lernsystem sagt: {}. Starten Sie die Einheit noch einmal im Kurs.',
    lost: 'Das Lernsystem antwortet nicht ({}). Ihre Arbeit geht weiter; der Kurs zählt sie vielleicht nicht.',
  },
  sv: {
    begins: 'Lärsystemet får veta ...', runs: '', leave: 'Lämna', left: 'Passet är slut. Du kan stänga sidan.',
    done: 'Arbetet är klart, och kursen vet det.', missing: '{} saknas i adressen. Starta enheten från kursen igen.',
    refused: 'Lärsystemet säger: {}. Starta enheten från kursen igen.',
    lost: 'Lärsystemet svarar inte ({}). Ditt arbete fortsätter; kursen räknar det kanske inte.',
  },
};

const $ = (id) => document.getElementById(id);
const asked = new URLSearchParams(location.search);
let language = [...navigator.languages].map((one) => one.slice(0, 2)).find((one) => one in kWords) ?? 'en';
const word = (key, ...parts) => kWords[language][key].replace(/\{\}/g, () => parts.shift());
const say = (text) => { $('say').textContent = text; };

let token = '', context = {}, normal = true, back = null, last_ms = 0;
let begun = 0, completed = false, terminated = false;
let order = Promise.resolve();  // statements go one after the other

class Refused extends Error {}

const endpoint = (asked.get('endpoint') ?? '').replace(/\/+$/, '');
const heads = () => ({Authorization: `Basic ${token}`, 'X-Experience-API-Version': '1.0.3', 'Content-Type': 'application/json'});
const get = (path, query) => fetch(`${endpoint}/${path}?${new URLSearchParams(query)}`, {headers: heads(), cache: 'no-store'});

async function begin() {
  for (const name of kParts) if (!asked.get(name)) throw new Refused(word('missing', name));
  const answer = await fetch(asked.get('fetch'), {method: 'POST', cache: 'no-store'});
  const given = await answer.json().catch(() => ({}));
  if (typeof given['auth-token'] !== 'string') throw new Refused(word('refused', given['error-text'] ?? answer.status));
  token = given['auth-token'];
  const agent = asked.get('actor'), registration = asked.get('registration'), activityId = asked.get('activityId');
  const state = await get('activities/state', {stateId: 'LMS.LaunchData', activityId, registration, agent});
  const data = await state.json().catch(() => null);
  if (!state.ok || typeof data?.contextTemplate?.extensions?.[kSession] !== 'string') throw new Refused(word('refused', `LMS.LaunchData ${state.status}`));
  context = data.contextTemplate;
  normal = (data.launchMode ?? 'Normal') === 'Normal';
  back = /^https?:/.test(data.returnURL ?? '') ? data.returnURL : null;
  const preferences = await get('agents/profile', {profileId: 'cmi5LearnerPreferences', agent});
  if (preferences.ok) {
    const wanted = `${(await preferences.json().catch(() => ({}))).languagePreference ?? ''}`.split(',').map((one) => one.trim().slice(0, 2));
    language = wanted.find((one) => one in kWords) ?? language;
  }
  document.documentElement.lang = language;
  begun = performance.now();
  await tell('initialized');
}

function statement(verb, result, moves_on) {
  const known = [context.contextActivities?.category ?? []].flat().filter(({id}) => id !== kCategory && id !== kMoveOn);
  const category = [...known, {id: kCategory}, ...(moves_on ? [{id: kMoveOn}] : [])];
  last_ms = Math.max(Date.now(), last_ms + 1);  // their order is told by the time
  return {
    id: crypto.randomUUID(),
    actor: JSON.parse(asked.get('actor')),
    verb: {id: `http://adlnet.gov/expapi/verbs/${verb}`, display: {en: verb}},
    object: {objectType: 'Activity', id: asked.get('activityId')},
    context: {...context, registration: asked.get('registration'), contextActivities: {...context.contextActivities, category}},
    timestamp: new Date(last_ms).toISOString(),
    ...(result && {result}),
  };
}
// The id stays the same, so trying again does no harm.
async function send(one, until) {
  for (let pause = 500;; pause *= 2) {
    const answer = await fetch(`${endpoint}/statements?statementId=${one.id}`, {method: 'PUT', headers: heads(), body: JSON.stringify(one), keepalive: true}).catch((what) => what);
    if ([200, 204, 409].includes(answer.status)) return;
    const again = !answer.status || answer.status === 429 || answer.status >= 500;
    if (!again) throw new Refused(word('refused', answer.status));
    if (performance.now() + pause > until) throw new Error(answer.status ?? answer.message);
    await new Promise((go) => setTimeout(go, pause));
  }
}
function tell(verb, result = null, moves_on = false) {
  const one = statement(verb, result, moves_on);
  const sent = order.then(() => send(one, performance.now() + kPatience));
  order = sent.catch(() => {});
  return sent;
}
const duration = () => `PT${Math.max(0, (performance.now() - begun) / 1000).toFixed(2)}S`;

async function complete() {
  if (completed || terminated || !normal) return;
  completed = true;
  await tell('completed', {completion: true, duration: duration()}, true);
  say(word('done'));
}
// What the browser has taken over is sent also when the page has gone.
function terminate() {
  if (terminated || begun === 0) return Promise.resolve();
  terminated = true;
  return tell('terminated', {duration: duration()});
}

const lost = (what) => say(what instanceof Refused ? what.message : word('lost', what.message));

function open_page() {
  const frame = $('burr'), at = new URL('../mill/', location.href);
  for (const name of ['case', 'mode']) if (asked.get(name)) at.searchParams.set(name, asked.get(name));
  at.searchParams.set('language', language);
  window.addEventListener('message', ({source, origin, data}) => {
    if (source !== frame.contentWindow || origin !== location.origin || data?.burr !== 1) return;
    if (data.kind === 'done') complete().catch(lost);
  });
  frame.src = at;
  $('leave').textContent = word('leave');
  $('leave').hidden = false;
  $('leave').addEventListener('click', async () => {
    frame.src = 'about:blank';  // it asks first, if it holds work that no file has
    $('leave').disabled = true;
    await terminate().catch(lost);
    if (back) location.assign(back);
    else say(word('left'));
  });
  window.addEventListener('pagehide', () => { terminate().catch(() => {}); });
}

say(word('begins'));
begin().then(() => {
  say(word('runs'));
  open_page();
}, (what) => {
  say(what instanceof Refused ? what.message : word('lost', what.message));
});
