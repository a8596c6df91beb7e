// The page "replay": a recording from a file of the user's, at any moment. The file goes to the worker of this page and
// nowhere else.
import {compile, start} from '../common/burr.js';
import {show} from '../common/skin.js';
import * as words from '../common/words.js';

const {word, number} = words;
const kTurn = 0.006;  // of the view, per pixel of the pointer  [rad]

const $ = (id) => document.getElementById(id);
const canvas = $('picture');

// What the tests and the curious read.
const burr = window.burr = {pictures: 0, ready: false, figures: {}, refined: () => view.view_refined() === 1};

let view = null, worker = null, compiled = null;
let seconds = 0, wanted = null, asked = false, playing = 0;  // playing: when it began, less the time shown [ms]
let dirty = true, seen = false, before = 0;
let moment = null;  // the newest from the worker
const waiting = [];

main().catch(fail);

async function main() {
  const [module] = await Promise.all([compile(), words.load()]);
  compiled = module;
  view = await start(compiled);
  if (view.view_open(...wanted_size()) === 0) throw new Error(word('no_webgl'));
  view.view_bone(0.5);
  for (const one of document.querySelectorAll('[data-word]')) one.textContent = word(one.dataset.word);
  $('home').textContent = word('first_view');
  $('play').textContent = word('play');
  $('file').setAttribute('aria-label', word('open_recording'));
  $('time').setAttribute('aria-label', word('time'));
  say(word('open_recording'));
  listen();
  burr.open = true;
  requestAnimationFrame(draw);
}

function fail(trouble) {
  burr.trouble = String(trouble?.message ?? trouble);
  say(word('broken', burr.trouble));
  console.error(trouble);
}
function say(text) {
  $('say').textContent = text;
}

function open(file) {
  worker?.terminate();
  burr.ready = seen = asked = false;
  moment = null;
  burr.shown = undefined;
  burr.refused = undefined;
  waiting.length = 0;
  playing = 0;
  wanted = null;
  $('play').disabled = $('time').disabled = true;
  say(word('loading'));
  worker = new Worker(new URL('worker.js', import.meta.url), {type: 'module'});
  worker.onmessage = ({data}) => hear(data);
  worker.onerror = (trouble) => fail(new Error(trouble.message || 'worker'));
  worker.postMessage({kind: 'open', compiled, file});
}

function hear(data) {
  switch (data.kind) {
    case 'opened':
      seconds = burr.seconds = data.seconds;
      for (const {name, told} of data.tissues)
        view.with_bytes([new TextEncoder().encode(name + '\0')], (text) => view.view_tissue(text, ...told));
      view.view_other_bone(data.voxel);
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
      seek(0);
      break;
    case 'moment':
      waiting.push(...data.patches, {row: data.row});
      moment = data;
      asked = false;
      break;
    case 'refused':
      burr.refused = data.why;
      say(data.why);
      asked = false;
      break;
    case 'broken':
      fail(new Error(data.text));
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
      worker.postMessage({kind: 'seek', time: wanted});
      wanted = null;
      asked = true;
    }
    const fresh = waiting.length > 0;
    for (const one of waiting) show(view, one);
    waiting.length = 0;
    if (fresh && !burr.ready) view.view_anew();
    if (fresh && !seen && burr.ready) {
      seen = true;
      view.view_whole();
    }
    fit();
    if (!dirty && !fresh && view.view_refined() === 1) return;
    dirty = false;
    const took = now - before;
    before = now;
    if (view.view_show(1e-3 * now, 1e-3 * took, 0) === 0) throw new Error(view.text(view.view_why()));
    ++burr.pictures;
    if (fresh) write();
  } catch (trouble) {
    fail(trouble);
  }
}

function write() {
  const [time, force, removed, size, rpm] = view.numbers(view.view_figures(), 8);
  burr.figures = {time, force, removed, size, rpm};
  burr.shown = moment?.time;
  burr.bone = moment?.bone;
  $('force').textContent = number(force, 1);
  $('removed').textContent = number(removed, 1);
  $('size').textContent = number(size, 1);
  $('rpm').textContent = number(rpm, 0);
  $('now').textContent = `${number(burr.shown ?? 0, 1)} / ${number(seconds, 1)} s`;
  if (playing !== 0 && moment) $('time').value = burr.shown;
}

function stop() {
  playing = 0;
  $('play').textContent = word('play');
}

function wanted_size() {
  const scale = Math.min(window.devicePixelRatio || 1, 2);
  return [Math.max(1, Math.round(canvas.clientWidth * scale)), Math.max(1, Math.round(canvas.clientHeight * scale))];
}
function fit() {
  const [wide, high] = wanted_size();
  if (canvas.width === wide && canvas.height === high) return;
  canvas.width = wide;
  canvas.height = high;
  dirty = true;
}

function listen() {
  $('file').addEventListener('change', () => { if ($('file').files[0]) open($('file').files[0]); });
  canvas.addEventListener('dragover', (event) => event.preventDefault());
  canvas.addEventListener('drop', (event) => {
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
    view.view_whole();
    dirty = true;
  });
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
  canvas.addEventListener('webglcontextlost', () => fail(new Error('WebGL')));
}
