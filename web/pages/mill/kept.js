// The session that this page keeps in the browser (kept_list.js shows all that are kept).
export const kLock = 'burr-session ';

export class Kept {
  constructor() {
    this.id = null;       // of this page's session
    this.failed = '';     // why it is kept no longer
    this.release = () => {};
  }
  // Another session of this page begins.
  begin() {
    this.release();
    this.failed = '';
    this.id = `${Date.now().toString(36)}-${Math.random().toString(36).slice(2, 8)}`;
    // held until the page goes, however it goes: so another page knows that somebody is at work
    navigator.locks?.request(kLock + this.id, () => new Promise((go) => { this.release = go; })).catch(() => {});
    return this.id;
  }
}
