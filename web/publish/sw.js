// Keeps one version of the page for use without a network. web/publish/publish.py fills in what stands between at signs.
//
// All parts of a version lie in a folder that its hash names, and the pages name that folder. So a page gets parts of its own
// version or none: from here, or from the host. A new version is kept whole, each file compared with its hash, before it answers;
// what has not changed is taken from the version before. The version before is forgotten when no open page holds its lock (offline.js).
const kFiles = @FILES@;    // path -> hash, as `integrity` wants it
const kFences = @FENCES@;  // the head that each answer carries, whatever the host sends
const kTypes = @TYPES@;
const kBase = new URL('./', self.location).href;
const kOurs = `burr ${kBase} `, kCache = `${kOurs}@PARTS@`;
const kList = `${kBase}files`;  // of a cache: what is in it
const kAtOnce = 4;

self.addEventListener('install', (event) => {
  self.skipWaiting();
  event.waitUntil(fill());
});
self.addEventListener('activate', (event) => event.waitUntil(Promise.all([self.clients.claim(), forget()])));
self.addEventListener('fetch', (event) => {
  const {method, url} = event.request;
  if (method !== 'GET' || !url.startsWith(kBase)) return;
  const {pathname, search} = new URL(url), path = pathname.slice(new URL(kBase).pathname.length);
  if (`${path}/index.html` in kFiles) return event.respondWith(Response.redirect(`${kBase}${path}/${search}`));
  const file = path === '' || path.endsWith('/') ? `${path}index.html` : path;
  if (file in kFiles) event.respondWith(kept(event.request, file, {cacheName: kCache}));
  else if (/^v-[0-9a-f]{16}\//.test(file)) event.respondWith(kept(event.request, file, {}));  // of the version before
  if (event.request.mode === 'navigate') event.waitUntil(forget());
});

async function kept(request, file, where) {
  return await caches.match(kBase + file, where) ?? fetch(request);
}

async function ours() {
  return (await caches.keys()).filter((name) => name.startsWith(kOurs));
}

// Either the whole version is kept, or nothing of it.
async function fill() {
  const before = new Map();  // hash -> where it is kept already
  for (const name of await ours()) {
    const list = await (await caches.match(kList, {cacheName: name}))?.json() ?? {};
    for (const [file, hash] of Object.entries(list)) before.set(hash, {name, file});
  }
  const cache = await caches.open(kCache);
  const waiting = Object.entries(kFiles);
  const take = async () => {
    for (let next = waiting.pop(); next; next = waiting.pop()) await keep(cache, ...next, before.get(next[1]));
  };
  try {
    await Promise.all(Array.from({length: kAtOnce}, take));
    await cache.put(kList, new Response(JSON.stringify(kFiles)));
  } catch (trouble) {
    await caches.delete(kCache);
    throw trouble;
  }
}

async function keep(cache, file, hash, before) {
  const old = before && await caches.match(kBase + before.file, {cacheName: before.name});
  // what a hash names may come from the browser's own cache; the host is asked for everything else
  const answer = old ?? await fetch(kBase + file, {integrity: hash, cache: file.startsWith('v-') ? 'default' : 'no-cache'});
  if (!answer.ok) throw new Error(`${file}: ${answer.status}`);
  const type = kTypes[file.slice(file.lastIndexOf('.'))];
  await cache.put(kBase + file, new Response(await answer.arrayBuffer(), {headers: {...kFences, 'Content-Type': type}}));
}

// Versions that no open page has. Where no locks can be asked for, all are kept.
async function forget() {
  const held = (await self.navigator.locks?.query())?.held;
  if (!held) return;
  const open = new Set(held.map((lock) => lock.name));
  for (const name of await ours())
    if (name !== kCache && !open.has(name) && await caches.match(kList, {cacheName: kCache})) await caches.delete(name);
}
