// The third worker of the page: looks at the newest row for how near the burr is to what must not be cut. It runs burr_score once more,
// which is compiled already, so that no measurement of a step delays a warning. The rows come straight from the worker that ticks,
// each when the one before was looked at: no slow picture delays them.
//
//     page -> worker   rows {port}, open {compiled, name, voxel, mode, language, work}, step {id}, language {language}, heard {on}, next;
//                      for tests: at {place}, and go_on
//     worker -> page   opened {allowed}, allowed {allowed}, looked {found}, broken {text}
//
// The page answers what was found with `next`; until then nothing is sent but a stop, and events are kept.
import make from '../burr_score.mjs';
import {start} from '../common/burr.js';

let burr = null;
let work = 0, ready = false, held = false, heard = false;
let shown = false;                 // the page has not answered yet
let newest = null, events = [];    // that the page does not have yet

self.onmessage = ({data}) => {
  queue = queue.then(() => take(data)).catch(broken);
};
let queue = Promise.resolve();

function tell(message) {
  self.postMessage({...message, work});
}
function broken(what) {
  ready = false;
  tell({kind: 'broken', text: String(what?.message ?? what)});
}
const json = (pointer) => JSON.parse(burr.text(pointer));

async function take(data) {
  if (data.kind === 'rows') {
    data.port.onmessage = ({data: one}) => row(one, data.port);
  } else if (data.kind === 'open') {
    work = data.work;
    ready = held = shown = false;
    newest = null;
    events = [];
    burr ??= await start(data.compiled, make);
    burr.with_texts([data.language], burr.watch_speak);
    if (!burr.with_texts([data.name, data.mode], (name, mode) => burr.watch_open(name, mode, data.voxel))) throw new Error(burr.text(burr.watch_why()));
    ready = true;
    tell({kind: 'opened', allowed: json(burr.watch_allowed())});
  } else if (data.work !== work) {
    return;  // about a bone that is gone
  } else if (data.kind === 'step') {
    burr.with_texts([data.id], burr.watch_step);
  } else if (data.kind === 'language') {
    burr.with_texts([data.language], burr.watch_speak);
    tell({kind: 'allowed', allowed: json(burr.watch_allowed())});
  } else if (data.kind === 'heard') {
    heard = data.on;
  } else if (data.kind === 'next') {
    shown = false;
    if (newest) send();
  } else if (data.kind === 'at') {
    held = true;
    burr.watch_put(...data.place);
    look();
    tell({kind: 'asked', found: newest ?? last});
  } else if (data.kind === 'go_on') {
    held = false;
  }
}

function row({bytes, work: of}, port) {
  port.postMessage(0);
  if (!ready || held || of !== work) return;
  try {
    burr.bytes(burr.watch_row(), bytes.length).set(bytes);
    look();
  } catch (what) {
    broken(what);
  }
}

let last = null;
function look() {
  newest = last = json(burr.watch_look(heard ? 1 : 0));
  events.push(...newest.events);
  if (!shown || newest.stop) send();
}
function send() {
  tell({kind: 'looked', found: {...newest, events}});
  shown = true;
  newest = null;
  events = [];
}
