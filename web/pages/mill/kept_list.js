// The work that this browser keeps: what was not finished is offered when the page is opened, and the menu shows all of it. Loaded when
// the first cut is possible.
import {forget_kept, kept_sessions} from '../common/store.js';
import * as words from '../common/words.js';
import {ask, button, make} from './ask.js';
import {kLock} from './kept.js';

const {word, number, duration} = words;
const kMost = 6;        // sessions that are kept; older ones go when another begins
const kAlive = 4000;    // where a page cannot lock: a session that was written so lately is still being made [ms]

export class KeptList {
  // kept: the session of this page. host: go_on(session), keep(bytes, name, type)
  constructor(kept, host) {
    this.kept = kept;
    this.host = host;
  }
  // As far as this page's own has come in the storage.
  async own() { return (await kept_sessions()).find(({id}) => id === this.kept.id); }

  // Sessions that no page is working at, newest first; those with nothing in them go.
  async free() {
    const held = navigator.locks ? new Set((await navigator.locks.query()).held.map((one) => one.name)) : null;
    const all = (await kept_sessions()).filter(({id, about}) => id !== this.kept.id && (held ? !held.has(kLock + id) : Date.now() - (about.at ?? about.begun) > kAlive));
    const worth = all.filter(({about}) => about.most > 0 || about.removed > 0);
    for (const one of all) if (!worth.includes(one)) await forget_kept(one.id);
    for (const one of worth.slice(kMost)) await forget_kept(one.id);
    return worth.slice(0, kMost);
  }

  // When the page is opened. True: something is offered.
  async offer() {
    const open = (await this.free()).filter(({about}) => about.state === 'open');
    if (open.length === 0) return false;
    this.show(open.slice(0, 1), word('kept_offer'));
    return true;
  }
  async show_all() { this.show(await this.free(), word('kept_work')); }

  show(sessions, title) {
    const line = ({about}) => word('kept_line', new Date(about.begun).toLocaleString(words.present(), {dateStyle: 'medium', timeStyle: 'short'}),
        duration(about.ticks / 1000), number(about.removed, 1));
    const rows = sessions.map((one) => {
      const row = make('li', {}, make('p', {}, line(one)), make('nav', {},
          button(word('kept_on'), () => { dialog.close(); this.host.go_on(one); }, {class: 'kept_on'}),
          button(word('save'), () => this.save(one), {class: 'kept_save'}),
          button(word('kept_delete'), (event) => this.remove(one, row, event.target), {class: 'kept_delete'})));
      return row;
    });
    const dialog = ask(title, [rows.length > 0 ? make('ul', {}, ...rows) : make('p', {}, word('kept_none'))], [['kept_later', word(rows.length > 0 ? 'kept_later' : 'close')]]);
    dialog.querySelector('.kept_on')?.focus();
  }
  async save(one) {
    this.host.keep(new Uint8Array(await (await one.file()).arrayBuffer()), 'burr.mcap', 'application/octet-stream');
  }
  // asked once more, on the same button
  async remove(one, row, pressed) {
    if (!pressed.dataset.sure) {
      pressed.dataset.sure = 'yes';
      pressed.textContent = word('kept_sure');
      return;
    }
    await forget_kept(one.id);
    row.remove();
  }
}
