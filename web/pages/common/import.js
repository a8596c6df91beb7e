// A scan of the user's becomes bone: asks for files, the level, the region and the memory, as the window does in
// more detail. The files go to a worker of this page and nowhere else.
import {bound_worker} from './bound_worker.js';
import * as words from './words.js';

const {word, number} = words;
const kMostBytes = 1e9;  // of the files: a module's memory ends at 2 GB
const kMemory = 1024, kLeastMemory = 64, kMostMemory = 1024;  // [MiB]

let worker = null, dialog = null, made = null;
let state = {};  // what the tests and the curious read

// page_state: what becomes of the scan is written there. on_bone({blob, plan}): the bone is there. files: that are read at once.
export function open_scan(page_state, on_bone, files = []) {
  made = on_bone;
  state = page_state;
  dialog ?? build();
  close();
  for (const one of dialog.querySelectorAll('[data-own]')) one.textContent = word(one.dataset.own);
  dialog.querySelector('#own_memory').value = kMemory;
  dialog.showModal();
  if (files.length > 0) read(files);
}

function close() {
  worker?.terminate();
  worker = null;
  delete state.plan;
  delete state.refused;
  dialog.querySelector('#own_files').value = '';
  dialog.querySelector('form').hidden = true;
  tell('');
}
function tell(text) {
  dialog.querySelector('#own_said').textContent = text;
}

function build() {
  const look = document.createElement('link');
  look.rel = 'stylesheet';
  look.href = new URL('import.css', import.meta.url);
  document.head.append(look);
  dialog = document.createElement('dialog');
  dialog.id = 'own_scan';
  const box = (id, word_key, from, to) => `<label><span data-own="${word_key}"></span>
    <input id="${id}" type="number" step="any" min="${from ?? ''}" max="${to ?? ''}"></label>`;
  const pair = (axis) => `<span class="pair">${axis} <input id="own_${axis}0" type="number" min="0" step="1" aria-label="${axis}">
    – <input id="own_${axis}1" type="number" min="0" step="1" aria-label="${axis}"></span>`;
  dialog.innerHTML = `<h2 data-own="own_scan"></h2>
    <p data-own="own_tip"></p>
    <label><span data-own="files_of_scan"></span> <input id="own_files" type="file" multiple></label>
    <p id="own_said" role="status"></p>
    <form hidden>
      ${box('own_level', 'own_level')}
      <fieldset><legend data-own="own_region"></legend>${['i', 'j', 'k'].map(pair).join(' ')}</fieldset>
      ${box('own_memory', 'own_memory', kLeastMemory, kMostMemory)}
      <p id="own_facts"></p>
      <button data-own="own_make"></button>
    </form>
    <button id="own_close" type="button" data-own="own_close"></button>`;
  document.body.append(dialog);
  const at = (id) => dialog.querySelector(id);
  at('#own_files').addEventListener('change', () => { if (at('#own_files').files.length > 0) read([...at('#own_files').files]); });
  at('#own_close').addEventListener('click', () => dialog.close());
  dialog.addEventListener('close', () => { if (!dialog.open) close(); });  // it comes late: the dialog may be open again
  at('form').addEventListener('change', () => worker?.postMessage({kind: 'plan', recipe: recipe()}));
  at('form').addEventListener('submit', (event) => {
    event.preventDefault();
    tell(word('own_making'));
    worker?.postMessage({kind: 'make', recipe: recipe()});
  });
  // the keys of the page are not meant here
  dialog.addEventListener('keydown', (event) => event.stopPropagation());
}

function read(files) {
  close_worker();
  worker = bound_worker(new URL('import_worker.js', import.meta.url));
  worker.onmessage = ({data}) => hear(data);
  worker.onerror = (what) => {
    what.preventDefault();
    hear({kind: 'refused', why: 'scan_broken', parts: []});
  };
  dialog.querySelector('form').hidden = true;
  delete state.refused;
  delete state.plan;
  if (files.reduce((sum, one) => sum + one.size, 0) > kMostBytes) return hear({kind: 'refused', why: 'scan_memory', parts: []});
  tell(word('own_reading'));
  worker.postMessage({kind: 'read', files, recipe: {memory_mb: kMemory}});
}
function close_worker() {
  worker?.terminate();
  worker = null;
}

// Numbers that are missing or wrong are the scan's own.
function recipe() {
  const value = (id) => dialog.querySelector(id).valueAsNumber;
  const memory = value('#own_memory');
  const asked = {memory_mb: Math.min(kMostMemory, Math.max(kLeastMemory, memory || kMemory)), allow_missing: true, as_it_is: true};  // what is doubtful is said before the bone is made
  if (!state.plan?.labels && Number.isFinite(value('#own_level'))) asked.iso = value('#own_level');
  const region = ['i', 'j', 'k'].flatMap((axis) => [value(`#own_${axis}0`), value(`#own_${axis}1`)]);
  if (region.every((one) => Number.isInteger(one))) asked.region = region;
  return asked;
}

function hear(data) {
  if (data.kind === 'refused') {
    state.refused = data.text ? in_words(data.text) : word(data.why, ...data.parts);
    tell(state.refused);
    if (data.why) close_worker();  // it has ended
    return;
  }
  if (data.kind === 'plan') {
    const first = !state.plan;
    state.plan = data.plan;
    delete state.refused;
    show(data.plan, first);
  } else if (data.kind === 'bone') {
    const take = made;
    dialog.close();
    take(data);
  }
}

function show(plan, first) {
  const at = (id) => dialog.querySelector(id);
  if (first) {
    ['i', 'j', 'k'].forEach((axis, n) => {
      at(`#own_${axis}0`).value = 0;
      at(`#own_${axis}1`).value = plan.scan[n] - 1;
      at(`#own_${axis}0`).max = at(`#own_${axis}1`).max = plan.scan[n] - 1;
    });
    at('#own_level').value = plan.labels ? '' : Math.round(1000 * plan.iso) / 1000;
    at('#own_level').disabled = plan.labels;
  }
  at('#own_facts').textContent = word('own_facts', plan.format, plan.scan.join(' × '),
      plan.spacing_mm.map((one) => number(one, 2)).join(' × '), plan.size.join(' × '), number(plan.voxel_mm, 2),
      number(plan.memory_mb, 0));
  tell(plan.notices.map(in_words).join(' '));
  at('form').hidden = false;
}

// A sentence of the library names its fields in backticks; here they are what stands in this dialog.
const kFields = {iso: 'own_level', level: 'own_level', region: 'own_region', memory_mb: 'own_memory', voxel_mm: 'own_memory', series: 'files_of_scan'};
function in_words(text) {
  return text.replace(/`([^`]*)`/g, (_, name) => (name in kFields ? `“${word(kFields[name])}”` : name.replaceAll('_', ' ').replace('::', ' ')));
}
