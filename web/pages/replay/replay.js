// The page "replay": a recording from a file of the user's, at any moment. The file goes to the worker of this page and
// nowhere else.
import {bound_worker} from '../common/bound_worker.js';
import {compile, start, trouble} from '../common/burr.js';
import {fit, is_lost, wanted_size} from '../common/canvas.js';
import {begin_bone, show} from '../common/skin.js';
import {kept_sessions} from '../common/store.js';
import * as words from '../common/words.js';

const {word, number} = words;
const kTurn = 0.006;  // of the view, per pixel of the pointer  [rad]
const kRing = 1.2e-3, kRound = 20e-3;  // around a place of evidence: the ring's radius, the height of the picture  [m]

const $ = (id) => document.getElementById(id);
let canvas = $('picture');
let lost = false;   // the browser has taken the picture away; it is being made anew

// What the tests and the curious read.
const burr = window.burr = {
  pictures: 0,
  ready: false,
  figures: {},
  refined: () => !lost && view.view_refined() === 1,
  hash: () => worker.postMessage({kind: 'hash', work}),  // gives burr.bone
  place: (x, y, z) => [...view.numbers(view.view_place(x, y, z, 0), 2)],  // of a point [m], in the picture [pixel]
  held: (tool) => {  // draws this tool of the recording; -1: the round burr
    view.view_tool(tool);
    dirty = true;
  },
};

let view = null, worker = null;
let seconds = 0, wanted = null, asked = false, playing = 0;  // playing: when it began, less the time shown [ms]
let dirty = true, seen = false, before = 0, drew = false;
let work = 0;       // number of the file
let moment = null;  // the newest from the worker
let place = null;   // of evidence [m]: the view turns to it, and a ring marks it
let turns = false;  // it has not turned yet
let come = null;    // to call when the worker is there
const waiting = [];

main().catch(fail);

async function main() {
  worker = bound_worker(new URL('worker.js', import.meta.url));
  worker.onmessage = ({data}) => hear(data);
  worker.onerror = (what) => fail(new Error(what.message || 'worker'));
  const here = new Promise((go) => { come = go; });
  const [module] = await Promise.all([compile(), words.load()]);
  view = await start(module);
  if (view.view_open(...wanted_size(canvas)) === 0) throw trouble('no_webgl');
  view.view_bone(0.5);
  for (const one of document.querySelectorAll('[data-word]')) one.textContent = word(one.dataset.word);
  $('home').textContent = word('first_view');
  canvas.setAttribute('aria-label', word('bone'));
  $('play').textContent = word('play');
  $('file').setAttribute('aria-label', word('open_recording'));
  $('time').setAttribute('aria-label', word('time'));
  await here;  // from now on nothing is fetched
  if (burr.trouble) return;
  say(word('open_recording'));
  listen();
  burr.open = true;
  requestAnimationFrame(draw);
  await open_link(new URLSearchParams(location.search));
}

// ?kept=ID&at=SECONDS&place=X,Y,Z: a recording that the page "mill" has kept in this browser, at a moment, turned to a place [m].
let first = 0;  // the moment to begin with [s]
async function open_link(asked) {
  const id = asked.get('kept');
  if (id === null) return;
  const found = (await kept_sessions()).find((one) => one.id === id);
  if (!found) return say(word('not_kept_here'));
  first = Number(asked.get('at')) || 0;
  const at = (asked.get('place') ?? '').split(',').map(Number);
  place = at.length === 3 && at.every(Number.isFinite) ? at : null;
  turns = place !== null;
  open(new File([await found.file()], 'burr.mcap'), true);
}

// The page stops, and its last sentence stays.
function fail(what) {
  if (burr.trouble) return;
  burr.trouble = String(what?.message ?? what);
  worker?.terminate();
  say(what?.why ? word(what.why, ...what.parts) : word('broken', burr.trouble));
  console.error(what);
}
function say(text) {
  $('say').textContent = text;
}

function open(file, linked = false) {
  if (!linked) {
    first = 0;
    place = null;
  }
  burr.ready = seen = asked = false;
  moment = null;
  burr.shown = undefined;
  burr.refused = undefined;
  waiting.length = 0;
  playing = 0;
  wanted = null;
  $('play').disabled = $('time').disabled = true;
  say(word('loading'));
  worker.postMessage({kind: 'open', file, work: ++work});
}

function hear(data) {
  if (data.kind === 'here') return come();
  if (burr.trouble || data.work !== work) return;
  switch (data.kind) {
    case 'opened':
      seconds = burr.seconds = data.seconds;
      begin_bone(view, data.tissues, data.voxel, data.rate, data.mouse);
      $('time').max = seconds;
      $('time').value = 0;
      break;
    case 'skin':
      waiting.push(...data.patches);
      break;
    case 'soft':
      waiting.push(...data.parts.map((one) => ({...one, soft: true})));
      break;
    case 'ready':
      burr.ready = true;
      $('play').disabled = $('time').disabled = false;
      say('');
      seek(first);
      break;
    case 'moment':
      waiting.push(...data.patches, {row: data.row}, {held: data.held});
      moment = data;
      asked = false;
      break;
    case 'hash':
      burr.bone = data.bone;
      return;
    case 'refused':
      burr.refused = word(data.why, ...data.parts);
      say(burr.refused);
      asked = false;
      break;
    case 'broken':
      fail(Object.assign(new Error(data.text), {why: data.why, parts: data.parts}));
      break;
  }
  dirty = true;
}

function seek(time) {
  wanted = Math.min(seconds, Math.max(0, time));
}

function draw(now) {
  requestAnimationFrame(draw);
  if (burr.trouble) return;
  try {
    if (playing !== 0) {
      seek((now - playing) / 1000);
      if (wanted >= seconds) stop();
    }
    if (burr.ready && wanted !== null && !asked) {
      worker.postMessage({kind: 'seek', time: wanted, work});
      wanted = null;
      asked = true;
    }
    const fresh = waiting.length > 0;
    for (const one of waiting) show(view, one);
    waiting.length = 0;
    if (lost) return;
    if (fresh && !burr.ready) view.view_anew();
    if (fresh && !seen && burr.ready) {
      seen = true;
      view.view_whole();
    }
    if (turns && seen && !asked && wanted === null && moment) {  // the bone of that moment is there
      turns = false;
      view.view_turn_to(...place, kRound);
      dirty = true;
    }
    if (fit(canvas)) dirty = true;
    const took = drew ? now - before : 0;  // of the picture before, if this one follows at once; a rest is no work
    before = now;
    drew = dirty || fresh || view.view_refined() === 0;
    if (!drew) return;
    dirty = false;
    if (view.view_show(1e-3 * now, 1e-3 * took, 0) === 0) {
      if (is_lost(canvas)) return lose();
      throw new Error(view.text(view.view_why()));
    }
    ++burr.pictures;
    draw_ring();
    if (fresh) write();
  } catch (trouble) {
    fail(trouble);
  }
}

function write() {
  const [time, force, removed, size, rpm] = view.numbers(view.view_figures(), 8);
  burr.figures = {time, force, removed, size, rpm};
  burr.shown = moment?.time;
  $('force').textContent = number(force, 1);
  $('removed').textContent = number(removed, 1);
  $('size').textContent = number(size, 1);
  $('rpm').textContent = number(rpm, 0);
  $('now').textContent = `${number(burr.shown ?? 0, 1)} / ${number(seconds, 1)} s`;
  if (playing !== 0 && moment) $('time').value = burr.shown;
}

function draw_ring() {
  const ring = $('light').firstElementChild;
  if (place !== null) {
    const [x, y, r] = view.numbers(view.view_place(...place, kRing), 3), scale = canvas.clientHeight / Math.max(1, canvas.height);
    for (const [name, value] of [['cx', scale * x], ['cy', scale * y], ['r', Math.max(8, scale * r)]]) ring.setAttribute(name, value);
    ring.setAttribute('visibility', r < 0 ? 'hidden' : 'visible');
  } else {
    ring.setAttribute('visibility', 'hidden');
  }
}

function stop() {
  playing = 0;
  $('play').textContent = word('play');
}

function listen() {
  $('file').addEventListener('change', () => { if ($('file').files[0]) open($('file').files[0]); });
  // on the whole window: a file that is dropped beside the canvas would take the place of the page
  window.addEventListener('dragover', (event) => event.preventDefault());
  window.addEventListener('drop', (event) => {
    event.preventDefault();
    if (event.dataTransfer.files[0]) open(event.dataTransfer.files[0]);
  });
  $('time').addEventListener('input', () => {
    stop();
    seek(Number($('time').value));
  });
  $('play').addEventListener('click', () => {
    if (playing !== 0) return stop();
    const from = burr.shown >= seconds ? 0 : burr.shown ?? 0;
    playing = performance.now() - 1000 * from;
    $('play').textContent = word('hold');
  });
  $('home').addEventListener('click', () => {
    if (lost) return;
    view.view_whole();
    dirty = true;
  });
  attach();
}

// The canvas that the picture is on; after a lost picture there is another one.
function attach() {
  const mine = canvas;
  let last = null;
  canvas.addEventListener('pointerdown', (event) => {
    canvas.setPointerCapture(event.pointerId);
    last = event;
  });
  canvas.addEventListener('pointermove', (event) => {
    if (!last || last.pointerId !== event.pointerId) return;
    const dx = event.clientX - last.clientX, dy = event.clientY - last.clientY;
    if (last.button === 1) view.view_pan(-dx / canvas.clientHeight, dy / canvas.clientHeight);
    else view.view_orbit(-kTurn * dx, kTurn * dy);
    last = {pointerId: event.pointerId, button: last.button, clientX: event.clientX, clientY: event.clientY};
    dirty = true;
  });
  for (const kind of ['pointerup', 'pointercancel']) canvas.addEventListener(kind, () => { last = null; });
  canvas.addEventListener('contextmenu', (event) => event.preventDefault());
  canvas.addEventListener('wheel', (event) => {
    event.preventDefault();
    view.view_zoom(Math.exp(-0.0015 * event.deltaY * (event.deltaMode === 1 ? 33 : 1)));
    dirty = true;
  }, {passive: false});
  canvas.addEventListener('webglcontextlost', (event) => {
    event.preventDefault();
    if (!lost && mine === canvas) lose();
  });
}
function lose() {
  lost = true;
  view.view_lost();
  say(word('picture_lost'));
  again(300);
}
function again(wait) {
  setTimeout(() => {
    const fresh = canvas.cloneNode(false);
    canvas.replaceWith(fresh);
    canvas = fresh;
    if (view.view_open(...wanted_size(canvas)) === 0) return again(Math.min(5000, 2 * wait));
    lost = false;
    dirty = true;
    attach();
    view.view_anew();
    say('');
  }, wait);
}
